// Before a trial: is the rig ready, camera by camera, and what is to be done.
#pragma once

#include <QLabel>
#include <QProgressBar>
#include <QPushButton>
#include <QTableWidget>
#include <QToolButton>
#include <QWidget>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "app/console/trial_desk.h"
#include "app/console/view/background_job.h"
#include "app/console/view/bridge.h"
#include "app/control/preflight/preflight.h"
#include "app/control/preflight/preflight_rig.h"

namespace elbowroom::console {

// Shows the rig of the trial that was opened last, or of a file that the user chooses. What can be known
// without the cameras is shown at once; they are looked at for some seconds when the user asks for it, and
// not while a trial has them. Thread: UI.
class PreflightPanel : public QWidget {
  Q_OBJECT

 public:
  static constexpr double kCheckS = 5.0;

  explicit PreflightPanel(TrialDesk& desk, QWidget* parent = nullptr);
  ~PreflightPanel() override;

  // A TRIAL.toml or a RIG.yml.
  void Open(const std::filesystem::path& file);
  // Runs the cameras for `seconds` and shows a row for each; does nothing where CanCheck() is false.
  void Check(double seconds = kCheckS);
  void Cancel();
  void ShowBackgroundButton(QAction* action);  // beside the panel's own buttons

  // Nothing: none was opened, or it couldn't be read.
  [[nodiscard]] const std::optional<control::PreflightRig>& rig() const { return rig_; }
  [[nodiscard]] QSize sizeHint() const override { return {440, 500}; }
  [[nodiscard]] bool CanCheck() const;
  [[nodiscard]] const std::vector<control::PreflightRow>& rows() const { return rows_; }

 signals:
  void RigChanged();
  void Checked(bool is_complete);  // false: it was cancelled, or failed

 protected:
  void changeEvent(QEvent* event) override;

 private:
  void Choose();
  void FollowDesk();
  void Run(double check_s);
  void Finish(const std::string& error);
  void ShowProgress(std::int64_t done, std::int64_t total, const std::string& what);
  void ShowRows();
  void ShowButtons();
  [[nodiscard]] QString Headline() const;

  struct Finding;

  TrialDesk& desk_;
  std::filesystem::path file_;
  std::optional<control::PreflightRig> rig_;
  std::vector<control::PreflightRow> rows_;
  int runs_ = 0;                 // jobs that were started
  bool has_checked_ = false;     // rows_ has the cameras'
  QLabel* file_name_ = nullptr;  // this and the next are owned by Qt as children
  QPushButton* choose_ = nullptr;
  QLabel* headline_ = nullptr;
  QTableWidget* table_ = nullptr;
  QProgressBar* progress_ = nullptr;
  QPushButton* check_ = nullptr;
  QPushButton* cancel_ = nullptr;
  QToolButton* background_ = nullptr;
  Bridge bridge_;  // before the thread that posts to it
  std::unique_ptr<BackgroundJob> job_;
};

}  // namespace elbowroom::console
