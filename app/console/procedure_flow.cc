#include "app/console/procedure_flow.h"

#include <QTimer>
#include <optional>
#include <utility>

#include "app/console/trial_actions.h"
#include "app/console/view/scrolled.h"
#include "app/control/trial_setup.h"
#include "core/error.h"
#include "core/procedure/answers.h"
#include "core/procedure/scores.h"
#include "sessions/after_trial.h"

namespace elbowroom::console {
namespace {

constexpr int kSidePx = 250;

bool HasProcedure(const core::TrialInfo& trial) {
  return !trial.steps.empty() || !trial.survey.empty() || !trial.questionnaires.empty() ||
         !trial.condition.empty() || !trial.block.empty() || trial.order > 0;
}

// Whether the trial asks what was answered.
bool Asks(const core::TrialInfo& trial, const core::EventContent& what) {
  if (const auto* answered = std::get_if<core::SurveyAnswered>(&what))
    return core::FindItem(trial, answered->when, answered->item) != nullptr;
  const auto* answered = std::get_if<core::QuestionnaireAnswered>(&what);
  if (answered == nullptr) return true;
  const core::Questionnaire* asked = core::FindQuestionnaire(trial, answered->when, answered->questionnaire);
  const core::QuestionnaireItem* item = asked == nullptr ? nullptr : core::FindItem(*asked, answered->item);
  return item != nullptr && core::CanBe(*item, answered->answer);
}

// What was said of the file as the page read it; the file may have changed since.
void Add(const SaidBefore& said, control::TrialSetup* setup) {
  setup->info.participant = said.participant;
  setup->info.estimate_mm = said.estimate_mm;
  for (const core::EventContent& what : said.events)
    if (Asks(setup->info, what)) setup->opening.push_back(what);
  if (!setup->info.steps.empty()) setup->first_step = setup->info.steps.front();
}

// Nothing for a file that can't be read: the desk says why.
std::optional<core::TrialInfo> InfoIn(const std::filesystem::path& trial_file) {
  try {
    return control::ReadTrialInfo(trial_file);
  } catch (const core::Error&) {
    return std::nullopt;
  }
}

}  // namespace

ProcedureFlow::ProcedureFlow(QMainWindow* window, TrialDesk& desk, SessionPlace& place,
                             SpacingPanel& spacings)
    : QObject(window),
      window_(window),
      desk_(desk),
      place_(place),
      spacings_(spacings),
      start_(new StartPage(window)),
      after_(new AfterPage(window)),
      procedure_(new ProcedurePanel),
      presets_(new PresetPanel(window)),
      sound_(new ContactSound(this)),
      next_(MakeAction("next_step_action", tr("&Next step"), Qt::Key_N,
                       tr("End the step of the procedure and begin the next one (N, or the space bar)"))),
      bookmark_(MakeAction("bookmark_action", tr("&Bookmark"), Qt::Key_M,
                           tr("Mark this moment of the trial (M)"))) {
  start_->hide();
  after_->hide();
  AddDocks();
  connect(next_, &QAction::triggered, procedure_, &ProcedurePanel::Next);
  connect(bookmark_, &QAction::triggered, procedure_, &ProcedurePanel::SetBookmark);
  procedure_->sound()->setChecked(sound_->is_on());
  connect(procedure_->sound(), &QCheckBox::toggled, sound_, &ContactSound::SetOn);
  connect(sound_, &ContactSound::Played, procedure_, &ProcedurePanel::ShowSound);
  connect(start_, &StartPage::BeginAsked, this, &ProcedureFlow::Begin);
  connect(start_, &StartPage::Left, this, &ProcedureFlow::Leave);
  connect(after_, &AfterPage::SaveAsked, this, &ProcedureFlow::Save);
  connect(after_, &AfterPage::Skipped, this, &ProcedureFlow::Leave);
  connect(presets_, &PresetPanel::GapsAsked, this, [this](const std::vector<double>& gap_mm) {
    for (std::size_t i = 0; i < gap_mm.size() && i < spacings_.controls().size(); ++i)
      spacings_.controls()[i]->Request(gap_mm[i]);
  });
  FollowDesk();
}

ProcedureFlow::~ProcedureFlow() = default;

QAction* ProcedureFlow::MakeAction(const char* name, const QString& text, Qt::Key key,
                                   const QString& tool_tip) {
  auto* action = new QAction(text, this);
  action->setObjectName(name);
  action->setShortcut(QKeySequence(key));
  action->setToolTip(tool_tip);
  return action;
}

void ProcedureFlow::AddDocks() {
  const auto add = [this](const char* name, const QString& title, QWidget* content) {
    auto* dock = new QDockWidget(title, window_);
    dock->setObjectName(name);
    dock->setWidget(Scrolled(content));
    window_->addDockWidget(Qt::LeftDockWidgetArea, dock);
    dock->hide();  // until a trial has a procedure
    docks_.push_back(dock);
  };
  add("procedure_panel", tr("Procedure"), procedure_);
  add("presets_panel", tr("Gap presets"), presets_);
  // One above the other they are higher than a small screen.
  window_->tabifyDockWidget(docks_.front(), docks_.back());
}

void ProcedureFlow::FollowDesk() {
  connect(procedure_, &ProcedurePanel::StepAsked, &desk_, &TrialDesk::BeginStep);
  connect(procedure_, &ProcedurePanel::BookmarkAsked, &desk_, &TrialDesk::SetBookmark);
  connect(&desk_, &TrialDesk::TrialOpened, this, &ProcedureFlow::Open);
  connect(&desk_, &TrialDesk::FrameArrived, this, &ProcedureFlow::ShowFrame);
  connect(&desk_, &TrialDesk::StateChanged, this, &ProcedureFlow::ShowState);
  ShowState();
}

void ProcedureFlow::Start(const std::filesystem::path& trial_file) {
  const std::optional<core::TrialInfo> trial = InfoIn(trial_file);
  if (!trial || !HasProcedure(*trial)) return StartTrialFile(desk_, trial_file, place_);
  ShowDocks(false);
  asked_file_ = trial_file;
  start_->Open(*trial);
  if (before_ == nullptr) before_ = pages_->trial_widget();
  pages_->SetTrialWidget(start_);
  pages_->Show(Page::kTrial);  // with its panels as they were left
  emit PreflightAsked(trial_file);
  start_->FocusEstimate();
}

void ProcedureFlow::Begin(const SaidBefore& said) {
  if (desk_.state() != DeskState::kIdle || desk_.are_cameras_taken())
    return emit Failed(tr("The cameras or the desk are busy: let the preflight end, then begin"));
  StartTrialFile(desk_, asked_file_, place_, [said](control::TrialSetup* setup) { Add(said, setup); });
}

// Back to what the trial page showed before.
void ProcedureFlow::Leave() {
  if (before_ != nullptr) pages_->SetTrialWidget(std::exchange(before_, nullptr));
}

void ProcedureFlow::Open(const control::TrialSetup& setup) {
  before_ = nullptr;  // the window shows its view
  trial_ = setup.info;
  has_procedure_ = HasProcedure(trial_);
  procedure_->Open(trial_.steps, !setup.first_step.empty());
  presets_->Open(setup.layout);
  sound_->Open();
  is_under_way_ = true;
  pages_->Show(Page::kTrial);  // with its panels as they were left
  ShowDocks(has_procedure_);
}

// Those that the user shows or hides for a trial without a procedure are left alone.
void ProcedureFlow::ShowDocks(bool are_shown) {
  if (std::exchange(has_shown_docks_, are_shown) == are_shown) return;
  for (QDockWidget* dock : docks_) dock->setVisible(are_shown);
  if (!are_shown) return;
  docks_.front()->raise();  // before the presets
  // When they have been laid out.
  QTimer::singleShot(0, this, [this] { window_->resizeDocks(docks_, {kSidePx, kSidePx}, Qt::Horizontal); });
}

void ProcedureFlow::ShowFrame(const FrameNews& news) {
  const control::FrameResult& result = *news.result;
  procedure_->ShowTime(result.record.time_s, result.step);
  presets_->ShowGaps(result.record.time_s, result.record.spacing_mm);
  sound_->ShowFrame(result.record.contacts);
}

// Also of a trial that failed, if it kept frames.
void ProcedureFlow::End() {
  if (!std::exchange(is_under_way_, false)) return;
  procedure_->ShowEnd();
  if (!has_procedure_ || !desk_.can_report()) return;
  asked_session_ = desk_.session();
  after_->Open(trial_);
  before_ = pages_->trial_widget();
  pages_->SetTrialWidget(after_);
  after_->FocusEstimate();
}

void ProcedureFlow::Save(const std::vector<core::EventContent>& said) {
  const std::filesystem::path session = asked_session_;
  job_ = std::make_unique<BackgroundJob>(
      bridge_, [session, said](const std::stop_token&) { sessions::AddAfterTrial(session, said); },
      [this, session](const std::string& error) {
        after_->SetIsSaving(false);
        if (!error.empty()) return emit Failed(QString::fromStdString(error));
        emit Told(tr("What was said is in the session %1")
                      .arg(QString::fromStdString(session.filename().string())));
        Leave();
      });
}

bool ProcedureFlow::HasAnswersFor(const std::filesystem::path& session) const {
  return pages_->trial_widget() == after_ && session == asked_session_ && after_->HasAnswers();
}

void ProcedureFlow::SaveAnswers() {
  if (!HasAnswers()) return;
  const std::vector<core::EventContent> said = after_->Said();
  Leave();
  sessions::AddAfterTrial(asked_session_, said);
}

void ProcedureFlow::ShowState() {
  if (desk_.state() == DeskState::kIdle) End();
  const bool is_running = desk_.state() == DeskState::kRunning && !desk_.is_stopping();
  procedure_->setEnabled(is_running);
  presets_->setEnabled(is_running);
  next_->setEnabled(is_running && !trial_.steps.empty());
  bookmark_->setEnabled(is_running);
}

}  // namespace elbowroom::console
