// The console's calibration page: a rig from a CALIB.toml, how exact it is, and what to do next.
#pragma once

#include <QDialog>
#include <QLabel>
#include <QListWidget>
#include <QProgressBar>
#include <QPushButton>
#include <QTableWidget>
#include <filesystem>
#include <memory>

#include "app/console/view/background_job.h"
#include "app/console/view/bridge.h"
#include "app/control/calibration/calibration_job.h"

namespace elbowroom::console {

// Calibrates on a thread of its own from the moment it is made. RIG.yml and the report, in the folder
// RIG-calibration beside it, are written whole once the calibration is there, or not at all. Closing the
// dialog cancels. Thread: UI.
class CalibrationDialog : public QDialog {
  Q_OBJECT

 public:
  CalibrationDialog(std::filesystem::path calibration_file, std::filesystem::path rig_file,
                    QWidget* parent = nullptr);
  ~CalibrationDialog() override;

  [[nodiscard]] bool is_running() const { return job_ != nullptr; }

 signals:
  void Ended(bool is_calibrated);

 private:
  void Start();
  void Finish(const std::string& error);
  void ShowProgress(std::int64_t done, std::int64_t total, const std::string& what);
  void ShowOutcome(const control::CalibrationOutcome& outcome);
  void ShowCameras(const control::CalibrationOutcome& outcome);
  [[nodiscard]] std::filesystem::path ReportFolder() const;

  std::filesystem::path calibration_file_;
  std::filesystem::path rig_file_;
  QLabel* headline_ = nullptr;  // this and the next are owned by Qt as children
  QProgressBar* progress_ = nullptr;
  QTableWidget* cameras_ = nullptr;
  QListWidget* advice_ = nullptr;
  QPushButton* open_report_ = nullptr;
  QPushButton* close_ = nullptr;
  std::shared_ptr<control::CalibrationOutcome> outcome_;
  Bridge bridge_;  // before the thread that posts to it
  std::unique_ptr<BackgroundJob> job_;
};

}  // namespace elbowroom::console
