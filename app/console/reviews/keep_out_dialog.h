// Asks how fine the keep-out volume of a session shall be, and where it is written.
#pragma once

#include <QDialog>
#include <QDoubleSpinBox>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <filesystem>

namespace elbowroom::console {

// Thread: UI.
class KeepOutDialog : public QDialog {
  Q_OBJECT

 public:
  KeepOutDialog(const std::filesystem::path& session, QWidget* parent);

 signals:
  void Asked(double edge_mm, const std::filesystem::path& file);

 private:
  void Browse();
  void Accept();

  QDoubleSpinBox* edge_;
  QLineEdit* file_;
  QPushButton* write_;
  QLabel* fault_;
  QString may_replace_;  // the file that was said to be replaced
};

}  // namespace elbowroom::console
