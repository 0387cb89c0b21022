#include "app/console/tool_panel.h"

#include <QVBoxLayout>

namespace elbowroom::console {
namespace {

constexpr std::size_t kMostKeys = 9;

}  // namespace

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
    if (boxes_.size() < kMostKeys) box->setToolTip(tr("In use, or not (key %1)").arg(boxes_.size() + 1));
    connect(box, &QCheckBox::toggled, this, [this, tool](bool in_use) { emit Marked(tool, in_use); });
    layout()->addWidget(box);
    boxes_.push_back(box);
  }
  setVisible(!tools.empty());
}

void ToolPanel::Toggle(std::size_t place) {
  if (isEnabled() && place < boxes_.size()) boxes_[place]->toggle();
}

}  // namespace elbowroom::console
