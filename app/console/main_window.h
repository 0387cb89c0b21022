// The console's one window.
#pragma once

#include <QDockWidget>
#include <QMainWindow>
#include <QStackedWidget>
#include <filesystem>

#include "app/console/camera_strip.h"
#include "app/console/contact_model.h"
#include "app/console/desktop/session_place.h"
#include "app/console/layouts/layout_page.h"
#include "app/console/note_line.h"
#include "app/console/page_switch.h"
#include "app/console/participant/participant_desk.h"
#include "app/console/preflight_panel.h"
#include "app/console/procedure_flow.h"
#include "app/console/reviews/review_page.h"
#include "app/console/sights/trial_sights.h"
#include "app/console/spacing_panel.h"
#include "app/console/status_line.h"
#include "app/console/tool_panel.h"
#include "app/console/touch_model.h"
#include "app/console/trial_actions.h"
#include "app/console/trial_desk.h"
#include "app/console/view/hull_look_button.h"
#include "app/console/view/message_bar.h"
#include "app/console/view/operator_view.h"

namespace elbowroom::console {

// Shows the desk's news and passes on what the user does; closing the window ends a running trial in order
// first.
// Thread: UI.
class MainWindow : public QMainWindow {
  Q_OBJECT

 public:
  // `session`: where the first trial is recorded; empty: in SessionsFolder().
  explicit MainWindow(std::filesystem::path session = {});
  ~MainWindow() override;

  [[nodiscard]] TrialDesk& desk() { return *desk_; }
  [[nodiscard]] SessionPlace& session_place() { return place_; }
  [[nodiscard]] OperatorView& view() { return *view_; }
  [[nodiscard]] TrialSights& sights() { return *sights_; }
  [[nodiscard]] CameraStrip& strip() { return *strip_; }
  [[nodiscard]] const StatusLine& status() const { return *status_; }
  [[nodiscard]] PreflightPanel& preflight() { return *preflight_; }
  [[nodiscard]] ParticipantDesk& participant() { return *participant_; }
  [[nodiscard]] PageSwitch& pages() { return *pages_; }
  [[nodiscard]] ProcedureFlow& procedure() { return *procedure_; }
  [[nodiscard]] LayoutPage& layout_page() { return *layout_page_; }
  [[nodiscard]] ReviewPage& review_page() { return *review_page_; }

  // A LAYOUT.toml goes to the layout page, a session to the review page, anything else is run as a trial.
  void OpenFile(const QString& file);

  // Takes size, place and panels from the last run, and leaves them for the next.
  void Remember();

  // On the review page.
  void OpenSession(const std::filesystem::path& session);
  void AskForSession();

 public slots:
  // Of a trial with a procedure its start page is shown first.
  void StartTrial(const QString& trial_file);
  [[nodiscard]] bool AsksForAnswers();
  void ShowError(const QString& line);

 protected:
  void dragEnterEvent(QDragEnterEvent* event) override;
  void dropEvent(QDropEvent* event) override;
  void changeEvent(QEvent* event) override;
  void closeEvent(QCloseEvent* event) override;
  void resizeEvent(QResizeEvent* event) override;
  void keyPressEvent(QKeyEvent* event) override;

 private:
  void AddActions();
  void AddMenus();
  void AddParticipant();
  void TakeIcons();  // those that have the text's colour
  [[nodiscard]] QMenu* ThemeMenu();
  void AddPreflight();
  void AddPanels();
  void AddPages(QStackedWidget* pages);
  // A panel that can be moved, floated and hidden; its name is for the settings.
  QDockWidget* AddPanel(const QString& name, const QString& title, QWidget* content, Qt::DockWidgetArea area);
  [[nodiscard]] QWidget* MakeCentre();
  void FollowDesk();
  void FollowProcedure();
  void FollowView();
  void OpenTrial(const control::TrialSetup& setup);
  void ShowFrame(const FrameNews& news);
  void ShowState();
  void FitPanels();
  [[nodiscard]] int WantedGapsPx() const;
  void FitTrialBar();
  void FitGaps();

  TrialDesk* desk_;  // this and all below are owned by Qt as children
  SessionPlace place_;
  bool closes_when_idle_ = false;
  int worded_bar_px_ = 0;   // of the trial's tool bar with words
  int fitted_gaps_px_ = 0;  // what FitGaps() made room for
  bool is_remembered_ = false;
  MessageBar* messages_ = nullptr;
  PageSwitch* pages_ = nullptr;
  ProcedureFlow* procedure_ = nullptr;
  LayoutPage* layout_page_ = nullptr;
  ReviewPage* review_page_ = nullptr;
  OperatorView* view_ = nullptr;
  TrialSights* sights_ = nullptr;
  HullLookButton* hull_look_ = nullptr;
  PreflightPanel* preflight_ = nullptr;
  QDockWidget* preflight_dock_ = nullptr;
  QDockWidget* cameras_dock_ = nullptr;
  CameraStrip* strip_ = nullptr;
  SpacingPanel* spacings_ = nullptr;
  ToolPanel* tools_ = nullptr;
  NoteLine* note_ = nullptr;
  ContactModel* contacts_ = nullptr;
  TouchModel* touches_ = nullptr;
  StatusLine* status_ = nullptr;
  ParticipantDesk* participant_ = nullptr;
};

}  // namespace elbowroom::console
