// The console's one window.
#pragma once

#include <QDockWidget>
#include <QMainWindow>
#include <filesystem>

#include "app/console/camera_strip.h"
#include "app/console/contact_model.h"
#include "app/console/hull_look_button.h"
#include "app/console/message_bar.h"
#include "app/console/operator_view.h"
#include "app/console/preflight_panel.h"
#include "app/console/spacing_panel.h"
#include "app/console/status_line.h"
#include "app/console/tool_panel.h"
#include "app/console/touch_model.h"
#include "app/console/trial_actions.h"
#include "app/console/trial_desk.h"

namespace elbowroom::console {

// Shows the desk's news and passes on what the user does; closing the window ends a running trial in order
// first.
// Thread: UI.
class MainWindow : public QMainWindow {
  Q_OBJECT

 public:
  // `session`: where the first trial is recorded; empty: the user is asked.
  explicit MainWindow(std::filesystem::path session = {});
  ~MainWindow() override;

  [[nodiscard]] TrialDesk& desk() { return *desk_; }
  [[nodiscard]] SessionChoice& session_choice() { return choice_; }
  [[nodiscard]] OperatorView& view() { return *view_; }
  [[nodiscard]] CameraStrip& strip() { return *strip_; }
  [[nodiscard]] const StatusLine& status() const { return *status_; }
  [[nodiscard]] PreflightPanel& preflight() { return *preflight_; }

 public slots:
  void ShowError(const QString& line);

 protected:
  void changeEvent(QEvent* event) override;
  void closeEvent(QCloseEvent* event) override;
  void keyPressEvent(QKeyEvent* event) override;

 private:
  void AddActions();
  void AddPreflight();
  [[nodiscard]] QWidget* MakeCentre();
  [[nodiscard]] QWidget* MakeSide();
  void FollowDesk();
  void OpenTrial(const control::TrialSetup& setup);
  void ShowFrame(const FrameNews& news);
  void ShowState();

  TrialDesk* desk_;  // this and all below are owned by Qt as children
  SessionChoice choice_;
  bool closes_when_idle_ = false;
  MessageBar* messages_ = nullptr;
  OperatorView* view_ = nullptr;
  HullLookButton* hull_look_ = nullptr;
  PreflightPanel* preflight_ = nullptr;
  QDockWidget* preflight_dock_ = nullptr;
  CameraStrip* strip_ = nullptr;
  SpacingPanel* spacings_ = nullptr;
  ToolPanel* tools_ = nullptr;
  ContactModel* contacts_ = nullptr;
  TouchModel* touches_ = nullptr;
  StatusLine* status_ = nullptr;
};

}  // namespace elbowroom::console
