#include "app/console/tool_panel.h"

#include <QVBoxLayout>

namespace elbowroom::console {

ToolPanel::ToolPanel(QWidget* parent) : QGroupBox(tr("Tools in use"), parent) {
  new QVBoxLayout(this);
  hide();
}

void ToolPanel::Open(const std::vector<std::string>& tools) {
  qDeleteAll(boxes_);
  boxes_.clear();
  for (const std::string& tool : tools) {
    auto* box = new QCheckBox(QString::fromStdString(tool));
    box->setObjectName("tool:" + box->text());
    connect(box, &QCheckBox::toggled, this, [this, tool](bool in_use) { emit Marked(tool, in_use); });
    layout()->addWidget(box);
    boxes_.push_back(box);
  }
  setVisible(!tools.empty());
}

}  // namespace elbowroom::console
