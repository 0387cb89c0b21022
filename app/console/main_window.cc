#include "app/console/main_window.h"

#include <QCloseEvent>
#include <QKeyEvent>
#include <QMenuBar>
#include <QMimeData>
#include <QScreen>
#include <QScrollArea>
#include <QTimer>
#include <QToolBar>
#include <QVBoxLayout>
#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "app/console/camera_actions.h"
#include "app/console/desktop/recent_trials.h"
#include "app/console/desktop/theme.h"
#include "app/console/desktop/welcome_page.h"
#include "app/console/desktop/window_memory.h"
#include "app/console/view/listing.h"
#include "app/console/view/scrolled.h"
#include "app/control/layout_editing/trial_draft.h"
#include "core/error.h"

namespace elbowroom::console {
namespace {

constexpr QSize kFirstSize(1360, 860);
constexpr double kCoarseStepMm = 10.0;
constexpr double kFineStepMm = 1.0;

// The keys − and +, with Shift for the fine step: on many keyboards Shift turns them into _ and *, and = into
// +.
std::optional<double> SpacingStepFor(const QKeyEvent& event) {
  const bool is_fine = event.modifiers().testFlag(Qt::ShiftModifier);
  const double step_mm = is_fine ? kFineStepMm : kCoarseStepMm;
  switch (event.key()) {
    case Qt::Key_Plus:
    case Qt::Key_Equal:
    case Qt::Key_Asterisk:
      return step_mm;
    case Qt::Key_Minus:
    case Qt::Key_Underscore:
      return -step_mm;
    default:
      return std::nullopt;
  }
}

bool IsSession(const QString& file) { return file.endsWith(".db", Qt::CaseInsensitive); }

// The file that was dropped, if it can be opened.
QString FileIn(const QMimeData* data) {
  if (data == nullptr || data->urls().size() != 1) return {};
  const QString file = data->urls().front().toLocalFile();
  return file.endsWith(".toml", Qt::CaseInsensitive) || IsSession(file) ? file : QString();
}

// What can't be read is for the trial's reader to say.
bool IsLayout(const QString& file) {
  try {
    return control::KindOf(file.toStdString()) == control::TomlKind::kLayout;
  } catch (const core::Error&) {
    return false;
  }
}

}  // namespace

MainWindow::MainWindow(std::filesystem::path session)
    : desk_(new TrialDesk(this)), place_(std::move(session)) {
  status_ = new StatusLine(this);
  setStatusBar(status_);
  setAcceptDrops(true);
  setDockOptions(AnimatedDocks | AllowNestedDocks | AllowTabbedDocks);
  setCorner(Qt::BottomRightCorner, Qt::RightDockWidgetArea);
  spacings_ = new SpacingPanel;
  view_ = new OperatorView;
  sights_ = new TrialSights(view_, this);
  sights_->hide();  // until a trial is opened
  AddPreflight();
  AddPanels();
  AddActions();
  AddMenus();
  setCentralWidget(MakeCentre());
  FollowProcedure();
  FollowDesk();
  FollowView();
  ShowState();
  resize(kFirstSize.boundedTo(screen()->availableGeometry().size()));
  FitPanels();
}

MainWindow::~MainWindow() = default;

void MainWindow::Remember() {
  is_remembered_ = true;
  RestoreWindow(this, kFirstSize);
}

void MainWindow::AddPreflight() {
  preflight_ = new PreflightPanel(*desk_);
  preflight_dock_ = AddPanel("preflight", tr("Preflight"), preflight_, Qt::LeftDockWidgetArea);
  preflight_dock_->hide();
}

QDockWidget* MainWindow::AddPanel(const QString& name, const QString& title, QWidget* content,
                                  Qt::DockWidgetArea area) {
  auto* dock = new QDockWidget(title, this);
  dock->setObjectName(name);
  dock->setWidget(content);
  addDockWidget(area, dock);
  return dock;
}

void MainWindow::AddPanels() {
  tools_ = new ToolPanel;
  note_ = new NoteLine;
  note_->setObjectName("note");
  auto* gaps = new QWidget;
  auto* column = new QVBoxLayout(gaps);
  column->setContentsMargins(4, 0, 4, 4);
  column->addWidget(spacings_);
  column->addWidget(tools_);
  column->addWidget(note_);
  column->addStretch(1);
  contacts_ = new ContactModel(this);
  touches_ = new TouchModel(this);
  auto* contact_list = new Listing(contacts_, tr("No contact in this frame"));
  contact_list->setObjectName("contact_list");
  contact_list->setAccessibleName(tr("Contacts now"));
  auto* touch_list = new Listing(touches_, tr("No parts yet"));
  touch_list->setObjectName("touch_list");
  touch_list->setAccessibleName(tr("Touches so far"));
  strip_ = new CameraStrip;
  AddPanel("gaps_panel", tr("Gaps and tools"), Scrolled(gaps), Qt::RightDockWidgetArea);
  AddPanel("contacts_panel", tr("Contacts now"), contact_list, Qt::RightDockWidgetArea);
  AddPanel("touches_panel", tr("Touches so far"), touch_list, Qt::RightDockWidgetArea);
  cameras_dock_ = AddPanel("cameras_panel", tr("Camera pictures"), strip_, Qt::BottomDockWidgetArea);
  cameras_dock_->hide();  // until there are cameras
  procedure_ = new ProcedureFlow(this, *desk_, place_, *spacings_);
  connect(spacings_, &SpacingPanel::Requested, desk_, &TrialDesk::SetSpacing);
  connect(tools_, &ToolPanel::Marked, desk_, &TrialDesk::MarkTool);
  connect(note_, &NoteLine::Written, desk_, &TrialDesk::AddNote);
}

// Two fifths of a small window for the figures, and no more than their columns need of a large one.
void MainWindow::FitPanels() {
  const auto named = [this](const char* name) { return findChild<QDockWidget*>(name); };
  const QList<QDockWidget*> side = {named("gaps_panel"), named("contacts_panel"), named("touches_panel")};
  const int side_px = std::clamp(2 * width() / 5, 400, 520);
  resizeDocks({side.front()}, {side_px}, Qt::Horizontal);
  const int list_px = height() / 3;
  resizeDocks(side, {list_px, list_px, list_px}, Qt::Vertical);
}

QWidget* MainWindow::MakeCentre() {
  messages_ = new MessageBar;
  auto* pages = new QStackedWidget;
  AddPages(pages);
  auto* centre = new QWidget;
  auto* column = new QVBoxLayout(centre);
  column->setContentsMargins(6, 6, 6, 2);
  column->addWidget(messages_);
  column->addWidget(pages, 1);
  return centre;
}

void MainWindow::AddPages(QStackedWidget* pages) {
  auto* welcome = new WelcomePage(findChild<QAction*>("start_demo"), findChild<QAction*>("open_trial"));
  welcome->setObjectName("trial");
  welcome->AddSamples({findChild<QAction*>("sample:payload"), findChild<QAction*>("sample:curtain"),
                       findChild<QAction*>("sample:faucet")});
  connect(welcome, &WelcomePage::TrialChosen, this, &MainWindow::OpenFile);
  layout_page_ = new LayoutPage;
  layout_page_->setObjectName("layout");
  connect(layout_page_, &LayoutPage::Failed, this, &MainWindow::ShowError);
  connect(layout_page_, &LayoutPage::TrialAsked, this, &MainWindow::StartTrial);
  connect(layout_page_, &LayoutPage::LayoutSaved, this, [](const QString& file) { RememberTrial(file); });
  menuBar()->insertMenu(menuBar()->actions().at(1), layout_page_->menu());
  review_page_ = new ReviewPage;
  review_page_->setObjectName("review");
  connect(review_page_, &ReviewPage::Failed, this, &MainWindow::ShowError);
  pages_ = new PageSwitch(this, pages);
  pages_->AddPage(Page::kLayout, tr("Layout"), tr("Import parts, place them, and make their rules"),
                  layout_page_);
  pages_->AddPage(Page::kTrial, tr("Trial"), tr("Run a trial and watch it"), welcome);
  pages_->AddPage(Page::kReview, tr("Review"), tr("Go through a recorded session"), review_page_);
  pages_->SetTools(Page::kReview, review_page_->actions());
  pages->setCurrentWidget(welcome);
  insertToolBar(findChild<QToolBar*>("trial_bar"), pages_);
}

void MainWindow::FollowView() {
  connect(view_, &OperatorView::Failed, this, &MainWindow::ShowError);
  connect(sights_, &TrialSights::Failed, this, &MainWindow::ShowError);
  connect(hull_look_, &HullLookButton::Chosen, view_, &OperatorView::SetLook);
  connect(view_, &OperatorView::PictureShown, this,
          [this](qint64, double drawing_ms) { status_->ShowPicture(drawing_ms, view_->driver()); });
  connect(view_, &OperatorView::PictureSeen, this,
          [this](qint64, double age_ms) { status_->ShowAge(age_ms); });
}

void MainWindow::resizeEvent(QResizeEvent* event) {
  QMainWindow::resizeEvent(event);
  FitTrialBar();
}

// Words beside the icons where there is room for them.
void MainWindow::FitTrialBar() {
  auto* bar = findChild<QToolBar*>("trial_bar");
  if (bar->toolButtonStyle() == Qt::ToolButtonTextBesideIcon) worded_bar_px_ = bar->sizeHint().width();
  const bool fits = pages_->sizeHint().width() + worded_bar_px_ <= width();
  bar->setToolButtonStyle(fits ? Qt::ToolButtonTextBesideIcon : Qt::ToolButtonIconOnly);
}

// Of gaps, their rules, tools and the note line, at the width that they have.
int MainWindow::WantedGapsPx() const {
  const auto* area = qobject_cast<QScrollArea*>(findChild<QDockWidget*>("gaps_panel")->widget());
  QLayout* content = area->widget()->layout();
  content->activate();
  return content->hasHeightForWidth() ? content->totalHeightForWidth(area->viewport()->width())
                                      : content->totalSizeHint().height();
}

// As high as they are, but no higher than half of the window.
void MainWindow::FitGaps() {
  auto* dock = findChild<QDockWidget*>("gaps_panel");
  fitted_gaps_px_ = WantedGapsPx();
  const int title_px = dock->height() - dock->widget()->height();
  const int gaps_px = std::min(title_px + fitted_gaps_px_, height() / 2);
  // One alone gets only a share of what it is given.
  auto *contacts = findChild<QDockWidget*>("contacts_panel"),
       *touches = findChild<QDockWidget*>("touches_panel");
  const int rest_px = std::max(0, dock->height() + contacts->height() + touches->height() - gaps_px);
  resizeDocks({dock, contacts, touches}, {gaps_px, rest_px / 2, rest_px / 2}, Qt::Vertical);
}

void MainWindow::StartTrial(const QString& trial_file) {
  if (desk_->state() != DeskState::kIdle || desk_->are_cameras_taken())
    return ShowError(tr("Another trial, or its report, is under way: stop it first"));
  if (AsksForAnswers()) return;
  procedure_->Start(trial_file.toStdString());
}

// What was said after a trial isn't lost without a word.
bool MainWindow::AsksForAnswers() {
  if (!procedure_->HasAnswers()) return false;
  pages_->Show(Page::kTrial);
  ShowError(tr("Save what was said after the trial (Ctrl+Enter), or skip it, first"));
  return true;
}

void MainWindow::FollowProcedure() {
  connect(procedure_, &ProcedureFlow::Failed, this, &MainWindow::ShowError);
  connect(procedure_, &ProcedureFlow::Told, messages_, &MessageBar::ShowNote);
  connect(procedure_, &ProcedureFlow::PreflightAsked, this, [this](const std::filesystem::path& trial_file) {
    preflight_->Open(trial_file);
    preflight_dock_->show();
  });
  procedure_->UsePages(pages_);
}

void MainWindow::OpenFile(const QString& file) {
  if (IsSession(file)) return OpenSession(file.toStdString());
  if (!IsLayout(file)) return StartTrial(file);
  pages_->Show(Page::kLayout);
  layout_page_->Open(file.toStdString());
}

void MainWindow::OpenSession(const std::filesystem::path& session) {
  if (procedure_->HasAnswersFor(session)) return (void)AsksForAnswers();  // which are written into it
  pages_->Show(Page::kReview);
  review_page_->Open(session);
}

void MainWindow::AskForSession() {
  pages_->Show(Page::kReview);
  review_page_->AskForSession();
}

void MainWindow::dragEnterEvent(QDragEnterEvent* event) {
  if (!FileIn(event->mimeData()).isEmpty() || !LayoutPage::CadFileIn(event->mimeData()).isEmpty())
    event->acceptProposedAction();
}

void MainWindow::dropEvent(QDropEvent* event) {
  event->acceptProposedAction();
  const QString cad_file = LayoutPage::CadFileIn(event->mimeData());
  if (cad_file.isEmpty()) return OpenFile(FileIn(event->mimeData()));
  pages_->Show(Page::kLayout);
  layout_page_->Import(cad_file.toStdString());
}

void MainWindow::FollowDesk() {
  connect(desk_, &TrialDesk::StateChanged, this, &MainWindow::ShowState);
  connect(desk_, &TrialDesk::TrialOpened, this, &MainWindow::OpenTrial);
  connect(desk_, &TrialDesk::HullArrived, view_, &OperatorView::Foresee);
  connect(desk_, &TrialDesk::FrameArrived, this, &MainWindow::ShowFrame);
  connect(desk_, &TrialDesk::TilesArrived, strip_, &CameraStrip::ShowTiles);
  connect(desk_, &TrialDesk::TilesArrived, sights_, &TrialSights::ShowTiles);
  connect(strip_, &CameraStrip::RoomChanged, sights_, &TrialSights::SetTileRoom);
  connect(strip_, &CameraStrip::CameraChosen, sights_, &TrialSights::ShowCamera);
  connect(sights_, &TrialSights::HeatWished, desk_, &TrialDesk::SetHeatWanted);
  connect(desk_, &TrialDesk::HeatArrived, sights_, &TrialSights::ShowHeat);
  connect(sights_, &TrialSights::WishesChanged, desk_, &TrialDesk::SetTileWishes);
  connect(desk_, &TrialDesk::Failed, this, &MainWindow::ShowError);
  connect(desk_, &TrialDesk::Progressed, status_, &StatusLine::ShowProgress);
  connect(desk_, &TrialDesk::TrialEnded, messages_, &MessageBar::ShowNote);
  connect(desk_, &TrialDesk::CameraKnocked, messages_, &MessageBar::ShowError);
  connect(desk_, &TrialDesk::RecordingChanged, this, [this](bool is_well, const QString& line) {
    if (is_well) {
      messages_->ShowNote(line);
    } else {
      messages_->ShowError(line);
    }
  });
  connect(desk_, &TrialDesk::ReportWritten, this, [this](const QString& html_file) {
    messages_->ShowNote(tr("The report is in %1").arg(html_file));
  });
}

void MainWindow::ShowError(const QString& line) { messages_->ShowError(line); }

void MainWindow::OpenTrial(const control::TrialSetup& setup) {
  messages_->hide();
  view_->Clear();
  sights_->Open(setup);
  pages_->SetTrialWidget(sights_);
  pages_->Show(Page::kTrial);
  cameras_dock_->show();
  strip_->Open(setup.source->rig());
  spacings_->Open(setup.layout);
  tools_->Open(setup.info.tools);
  QTimer::singleShot(0, this, &MainWindow::FitGaps);  // when the panels have been laid out
  contacts_->Clear();
  touches_->Open(setup.layout);
  status_->Open(desk_->session());
  if (!setup.warnings.empty()) messages_->ShowNote(QString::fromStdString(setup.warnings.front()));
  setWindowTitle(setup.info.task.empty() ? tr("Elbowroom")
                                         : tr("Elbowroom – %1").arg(QString::fromStdString(setup.info.task)));
}

void MainWindow::ShowFrame(const FrameNews& news) {
  view_->ShowFrame(news.result);
  sights_->ShowFrame(news.result);
  spacings_->ShowApplied(news.result->record.spacing_mm);
  spacings_->ShowPairs(*news.result);
  if (WantedGapsPx() > fitted_gaps_px_)  // lines of pair rules came, or wrap
    QTimer::singleShot(0, this, &MainWindow::FitGaps);
  contacts_->ShowFrame(*news.result);
  touches_->ShowFrame(*news.result, news.tallies);
  status_->ShowFrame(*news.result, news.recorded);
}

void MainWindow::ShowState() {
  const bool is_running = desk_->state() == DeskState::kRunning && !desk_->is_stopping();
  if (desk_->state() == DeskState::kRunning) preflight_dock_->hide();  // it is for before a trial
  spacings_->setEnabled(is_running);
  tools_->setEnabled(is_running);
  note_->setEnabled(is_running);
  if (desk_->state() == DeskState::kIdle) {
    status_->HideProgress();
    // Once this is told to all: what isn't saved may be asked for.
    if (std::exchange(closes_when_idle_, false))
      QMetaObject::invokeMethod(this, &MainWindow::close, Qt::QueuedConnection);
  }
}

void MainWindow::changeEvent(QEvent* event) {
  QMainWindow::changeEvent(event);
  if (event->type() == QEvent::WindowStateChange && strip_ != nullptr)
    strip_->SetWindowMinimized(isMinimized());
  if (event->type() == QEvent::PaletteChange) TakeIcons();
}

void MainWindow::closeEvent(QCloseEvent* event) {
  if (AsksForAnswers()) return event->ignore();
  if (desk_->state() == DeskState::kIdle) {
    if (layout_page_->desk().is_unsaved()) {
      pages_->Show(Page::kLayout);
      layout_page_->Leave([this] { close(); });
      return event->ignore();
    }
    pages_->Show(Page::kTrial);  // whose panels are remembered
    if (is_remembered_) SaveWindow(*this);
    return event->accept();
  }
  closes_when_idle_ = true;  // and asks then: no box stands before a trial
  desk_->Stop();
  messages_->ShowNote(tr("Closing as soon as the session is complete …"));
  event->ignore();
}

void MainWindow::keyPressEvent(QKeyEvent* event) {
  if (pages_->page() != Page::kTrial) return QMainWindow::keyPressEvent(event);
  if (const std::optional<double> step_mm = SpacingStepFor(*event)) {
    spacings_->StepActive(*step_mm);
  } else if (event->key() >= Qt::Key_1 && event->key() <= Qt::Key_9) {
    tools_->Toggle(static_cast<std::size_t>(event->key() - Qt::Key_1));
  } else if (event->key() == Qt::Key_Space) {
    procedure_->Next();
  } else {
    QMainWindow::keyPressEvent(event);
  }
}

}  // namespace elbowroom::console
