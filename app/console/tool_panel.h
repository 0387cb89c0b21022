// Which tools the participant has in hand, as the experimenter marks it.
#pragma once

#include <QCheckBox>
#include <QGroupBox>
#include <string>
#include <vector>

namespace elbowroom::console {

// Thread: UI.
class ToolPanel : public QGroupBox {
  Q_OBJECT

 public:
  explicit ToolPanel(QWidget* parent = nullptr);

  void Open(const std::vector<std::string>& tools);  // all not in use; without tools the panel hides
  void Toggle(std::size_t place);                    // in the order of Open; does nothing beyond the last

 signals:
  void Marked(const std::string& tool, bool in_use);

 private:
  std::vector<QCheckBox*> boxes_;  // owned by Qt as children
};

}  // namespace elbowroom::console
