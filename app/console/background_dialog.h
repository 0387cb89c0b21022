// The console's page that takes the empty scene with the live cameras.
#pragma once

#include <QCheckBox>
#include <QDialog>
#include <QDoubleSpinBox>
#include <QLabel>
#include <QLineEdit>
#include <QProgressBar>
#include <QPushButton>
#include <filesystem>
#include <memory>

#include "app/console/view/background_job.h"
#include "app/console/view/bridge.h"
#include "app/control/cameras/background_taking.h"
#include "recon/rig_files/rig_file.h"

namespace elbowroom::console {

// Asks for a folder, counts down, takes the pictures on a thread of its own, and says what came of it. The
// folder appears whole or not at all. Closing the dialog cancels. Thread: UI.
class BackgroundDialog : public QDialog {
  Q_OBJECT

 public:
  // `folder`: the one that is proposed.
  BackgroundDialog(recon::RigFile rig_file, const std::filesystem::path& folder, QWidget* parent = nullptr);
  ~BackgroundDialog() override;

  void Start();
  [[nodiscard]] bool is_running() const { return job_ != nullptr; }

 signals:
  void Began();                         // the cameras are in use
  void Ended(bool is_taken);            // and no longer
  void Taken(const QString& rig_file);  // the RIG.yml that uses the background

 private:
  void ShowProgress(std::int64_t done, std::int64_t total, const std::string& what);
  void Finish(const std::string& error, const control::BackgroundOutcome& outcome);
  void SetRunning(bool is_running);

  recon::RigFile rig_file_;
  QLineEdit* folder_ = nullptr;  // this and the next are owned by Qt as children
  QDoubleSpinBox* countdown_s_ = nullptr;
  QDoubleSpinBox* seconds_ = nullptr;
  QCheckBox* anyway_ = nullptr;
  QLabel* headline_ = nullptr;
  QProgressBar* progress_ = nullptr;
  QPushButton* start_ = nullptr;
  QPushButton* close_ = nullptr;
  Bridge bridge_;  // before the thread that posts to it
  std::unique_ptr<BackgroundJob> job_;
};

}  // namespace elbowroom::console
