// What was said of the chosen touch, and a line to say more.
#pragma once

#include <QComboBox>
#include <QGroupBox>
#include <QLineEdit>
#include <QPushButton>
#include <QTextBrowser>
#include <optional>

#include "core/findings/finding.h"

namespace elbowroom::console {

// Thread: UI.
class RemarkPanel : public QGroupBox {
  Q_OBJECT

 public:
  explicit RemarkPanel(QWidget* parent = nullptr);

  void Open(const core::Finding& finding);
  void Clear();
  void SetCanSay(bool can_say);

 signals:
  // A status that differs from the present one, or a comment, or both; by whom and when.
  void Said(const elbowroom::core::FindingId& finding, const elbowroom::core::ReviewRemark& remark);

 private:
  void Say();
  void Enable();
  [[nodiscard]] std::optional<core::ReviewStatus> NewStatus() const;

  std::optional<core::Finding> finding_;
  bool can_say_ = true;
  QTextBrowser* said_;
  QComboBox* status_;
  QLineEdit* comment_;
  QLineEdit* name_;
  QPushButton* say_;
};

}  // namespace elbowroom::console
