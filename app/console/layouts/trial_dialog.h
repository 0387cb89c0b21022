// What a trial with this layout needs: a rig, who, what, and where the TRIAL.toml goes.
#pragma once

#include <QDialog>
#include <QDoubleSpinBox>
#include <QLabel>
#include <QLineEdit>
#include <filesystem>

#include "app/control/layout_editing/trial_draft.h"

namespace elbowroom::console {

// Writes the TRIAL.toml when its button is pressed; what can't be is said in place. The rig and the names of
// the last time are proposed. Thread: UI.
class TrialDialog : public QDialog {
  Q_OBJECT

 public:
  explicit TrialDialog(const std::filesystem::path& layout, QWidget* parent = nullptr);

 signals:
  void Written(const QString& trial_file);

 private:
  void BuildForm();
  void BrowseRig();
  void BrowseFile();
  void Write();
  void ShowFault(const QString& line);
  [[nodiscard]] control::TrialDraft Draft() const;

  std::filesystem::path layout_;
  QLineEdit* rig_ = nullptr;  // this and the next are owned by Qt as children
  QLineEdit* participant_ = nullptr;
  QLineEdit* task_ = nullptr;
  QDoubleSpinBox* estimate_mm_ = nullptr;
  QDoubleSpinBox* clearance_mm_ = nullptr;
  QLineEdit* tools_ = nullptr;
  QLineEdit* file_ = nullptr;
  QLabel* fault_ = nullptr;
  QString may_replace_;  // a file that the user was told is there
};

}  // namespace elbowroom::console
