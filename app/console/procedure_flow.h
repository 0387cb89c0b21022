// Leads a trial that has a procedure: its start page, its panels while it runs, its page afterwards.
#pragma once

#include <QAction>
#include <QDockWidget>
#include <QMainWindow>
#include <QObject>
#include <filesystem>
#include <memory>
#include <vector>

#include "app/console/desktop/session_place.h"
#include "app/console/page_switch.h"
#include "app/console/procedure/after_page.h"
#include "app/console/procedure/contact_sound.h"
#include "app/console/procedure/preset_panel.h"
#include "app/console/procedure/procedure_panel.h"
#include "app/console/procedure/start_page.h"
#include "app/console/spacing_panel.h"
#include "app/console/trial_desk.h"
#include "app/console/view/background_job.h"
#include "app/console/view/bridge.h"

namespace elbowroom::console {

// A trial file with a condition, an order, a block, steps or a survey has a procedure; any other trial starts
// at once, as the demo does. The window owns pages and panels. Thread: UI.
class ProcedureFlow : public QObject {
  Q_OBJECT

 public:
  ProcedureFlow(QMainWindow* window, TrialDesk& desk, SessionPlace& place, SpacingPanel& spacings);
  ~ProcedureFlow() override;

  // Whose trial page the pages take the place of.
  void UsePages(PageSwitch* pages) { pages_ = pages; }

  // Starts the trial of the file, or asks first what its procedure has to ask. Throws: core::Error for what
  // the file has wrong, and what StartTrialFile throws.
  void Start(const std::filesystem::path& trial_file);

  void Next() { procedure_->Next(); }

  // Something was said after that trial that isn't in its session yet.
  [[nodiscard]] bool HasAnswersFor(const std::filesystem::path& session) const;
  [[nodiscard]] bool HasAnswers() const { return HasAnswersFor(asked_session_); }
  // At once, where nobody is there to ask. Throws: what sessions::AddAfterTrial throws.
  void SaveAnswers();

  // Next step and bookmark, for a menu.
  [[nodiscard]] QList<QAction*> actions() const { return {next_, bookmark_}; }

 signals:
  void Failed(const QString& line);
  void Told(const QString& line);
  void PreflightAsked(const std::filesystem::path& trial_file);

 private:
  void AddDocks();
  [[nodiscard]] QAction* MakeAction(const char* name, const QString& text, Qt::Key key,
                                    const QString& tool_tip);
  void FollowDesk();
  void Begin(const SaidBefore& said);
  void Leave();
  void Open(const control::TrialSetup& setup);
  void ShowFrame(const FrameNews& news);
  void End();
  void Save(const std::vector<core::EventContent>& said);
  void ShowDocks(bool are_shown);
  void ShowState();

  QMainWindow* window_;
  TrialDesk& desk_;
  SessionPlace& place_;
  SpacingPanel& spacings_;
  PageSwitch* pages_ = nullptr;
  QWidget* before_ = nullptr;            // what the trial page showed before the start page
  std::filesystem::path asked_file_;     // of the start page
  std::filesystem::path asked_session_;  // of the page after a trial
  core::TrialInfo trial_;                // of the running trial, or the last one
  bool is_under_way_ = false;
  bool has_shown_docks_ = false;
  bool has_procedure_ = false;  // likewise
  StartPage* start_;            // this and the next are owned by Qt
  AfterPage* after_;
  ProcedurePanel* procedure_;
  PresetPanel* presets_;
  ContactSound* sound_;
  QAction* next_;
  QAction* bookmark_;
  QList<QDockWidget*> docks_;
  Bridge bridge_;  // before the thread that posts to it
  std::unique_ptr<BackgroundJob> job_;
};

}  // namespace elbowroom::console
