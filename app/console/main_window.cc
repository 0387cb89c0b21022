#include "app/console/main_window.h"

#include <QCloseEvent>
#include <QKeyEvent>
#include <QMenu>
#include <QSplitter>
#include <QToolBar>
#include <QToolButton>
#include <QVBoxLayout>
#include <optional>
#include <utility>

#include "app/console/camera_actions.h"
#include "app/console/listing.h"

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

QGroupBox* Boxed(const QString& title, QWidget* content) {
  auto* box = new QGroupBox(title);
  auto* column = new QVBoxLayout(box);
  column->setContentsMargins(6, 6, 6, 6);
  column->addWidget(content);
  return box;
}

}  // namespace

MainWindow::MainWindow(std::filesystem::path session)
    : desk_(new TrialDesk(this)), choice_(std::move(session)) {
  status_ = new StatusLine(this);
  setStatusBar(status_);
  spacings_ = new SpacingPanel;
  AddPreflight();
  AddActions();
  auto* splitter = new QSplitter(Qt::Horizontal);
  splitter->setChildrenCollapsible(false);
  splitter->addWidget(MakeCentre());
  splitter->addWidget(MakeSide());
  splitter->setStretchFactor(0, 1);
  splitter->setSizes({kFirstSize.width() - 460, 460});
  setCentralWidget(splitter);
  FollowDesk();
  ShowState();
  resize(kFirstSize);
}

MainWindow::~MainWindow() = default;

void MainWindow::AddPreflight() {
  preflight_ = new PreflightPanel(*desk_);
  preflight_dock_ = new QDockWidget(tr("Preflight"), this);
  preflight_dock_->setObjectName("preflight");
  preflight_dock_->setWidget(preflight_);
  addDockWidget(Qt::LeftDockWidgetArea, preflight_dock_);
  preflight_dock_->hide();
}

void MainWindow::AddActions() {
  auto* bar = addToolBar(tr("Trial"));
  bar->setMovable(false);
  bar->setToolButtonStyle(Qt::ToolButtonTextBesideIcon);
  auto* demo = new StartDemoAction(*desk_, choice_, this);
  demo->setObjectName("start_demo");
  auto* open = new OpenTrialAction(*desk_, choice_, this);
  open->setObjectName("open_trial");
  auto* calibrate = new CalibrateAction(*desk_, this);
  calibrate->setObjectName("calibrate");
  auto* stop = new StopAction(*desk_, this);
  stop->setObjectName("stop");
  auto* report = new ReportAction(*desk_, this);
  report->setObjectName("report");
  auto* undo = new UndoGapAction(*spacings_, this);
  undo->setObjectName("undo_gap");
  auto* redo = new RedoGapAction(*spacings_, this);
  redo->setObjectName("redo_gap");
  hull_look_ = new HullLookButton;
  hull_look_->setObjectName("hull_look");
  auto* preflight = preflight_dock_->toggleViewAction();
  preflight->setObjectName("show_preflight");
  preflight->setText(tr("&Preflight"));
  preflight->setToolTip(tr("See before a trial whether cameras, background, calibration and disk are ready"));
  auto* background = new TakeBackgroundAction(*desk_, *preflight_, this);
  background->setObjectName("take_background");
  preflight_->ShowBackgroundButton(background);
  auto* menu = new QMenu(this);
  menu->setToolTipsVisible(true);
  menu->addActions({preflight, background});
  auto* cameras = new QToolButton;
  cameras->setObjectName("cameras");
  cameras->setText(tr("Ca&meras"));
  cameras->setPopupMode(QToolButton::InstantPopup);
  cameras->setMenu(menu);
  bar->addActions({demo, open, calibrate});
  bar->addWidget(cameras);
  bar->addSeparator();
  bar->addAction(stop);
  bar->addSeparator();
  bar->addAction(report);
  bar->addSeparator();
  bar->addActions({undo, redo});
  bar->addSeparator();
  bar->addWidget(hull_look_);
}

QWidget* MainWindow::MakeCentre() {
  messages_ = new MessageBar;
  view_ = new OperatorView;
  strip_ = new CameraStrip;
  auto* centre = new QWidget;
  auto* column = new QVBoxLayout(centre);
  column->setContentsMargins(8, 8, 4, 4);
  column->addWidget(messages_);
  column->addWidget(view_, 1);
  column->addWidget(strip_);
  connect(view_, &OperatorView::Failed, this, &MainWindow::ShowError);
  connect(hull_look_, &HullLookButton::Chosen, view_, &OperatorView::SetLook);
  connect(view_, &OperatorView::PictureShown, this,
          [this](qint64, double drawing_ms) { status_->ShowPicture(drawing_ms, view_->driver()); });
  connect(view_, &OperatorView::PictureSeen, this,
          [this](qint64, double age_ms) { status_->ShowAge(age_ms); });
  return centre;
}

QWidget* MainWindow::MakeSide() {
  tools_ = new ToolPanel;
  contacts_ = new ContactModel(this);
  touches_ = new TouchModel(this);
  auto* contact_list = new Listing(contacts_, tr("No contact in this frame"));
  contact_list->setObjectName("contact_list");
  auto* touch_list = new Listing(touches_, tr("No parts yet"));
  touch_list->setObjectName("touch_list");
  auto* side = new QWidget;
  side->setMinimumWidth(380);
  auto* column = new QVBoxLayout(side);
  column->setContentsMargins(4, 8, 8, 4);
  column->addWidget(spacings_);
  column->addWidget(tools_);
  column->addWidget(Boxed(tr("Contacts now"), contact_list), 1);
  column->addWidget(Boxed(tr("Touches so far"), touch_list), 1);
  connect(spacings_, &SpacingPanel::Requested, desk_, &TrialDesk::SetSpacing);
  connect(tools_, &ToolPanel::Marked, desk_, &TrialDesk::MarkTool);
  return side;
}

void MainWindow::FollowDesk() {
  connect(desk_, &TrialDesk::StateChanged, this, &MainWindow::ShowState);
  connect(desk_, &TrialDesk::TrialOpened, this, &MainWindow::OpenTrial);
  connect(desk_, &TrialDesk::HullArrived, view_, &OperatorView::Foresee);
  connect(desk_, &TrialDesk::FrameArrived, this, &MainWindow::ShowFrame);
  connect(desk_, &TrialDesk::TilesArrived, strip_, &CameraStrip::ShowTiles);
  connect(strip_, &CameraStrip::RoomChanged, desk_, &TrialDesk::SetTileRoom);
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
  strip_->Open(setup.source->rig());
  spacings_->Open(setup.layout);
  tools_->Open(setup.info.tools);
  contacts_->Clear();
  touches_->Open(setup.layout);
  status_->Open(desk_->session());
  if (!setup.warnings.empty()) messages_->ShowNote(QString::fromStdString(setup.warnings.front()));
  setWindowTitle(setup.info.task.empty() ? tr("Elbowroom")
                                         : tr("Elbowroom – %1").arg(QString::fromStdString(setup.info.task)));
}

void MainWindow::ShowFrame(const FrameNews& news) {
  view_->ShowFrame(news.result);
  spacings_->ShowApplied(news.result->record.spacing_mm);
  spacings_->ShowPairs(*news.result);
  contacts_->ShowFrame(*news.result);
  touches_->ShowFrame(*news.result, news.tallies);
  status_->ShowFrame(*news.result, news.recorded);
}

void MainWindow::ShowState() {
  const bool is_running = desk_->state() == DeskState::kRunning && !desk_->is_stopping();
  if (desk_->state() == DeskState::kRunning) preflight_dock_->hide();  // it is for before a trial
  spacings_->setEnabled(is_running);
  tools_->setEnabled(is_running);
  if (desk_->state() == DeskState::kIdle) {
    status_->HideProgress();
    if (closes_when_idle_) close();
  }
}

void MainWindow::changeEvent(QEvent* event) {
  QMainWindow::changeEvent(event);
  if (event->type() == QEvent::WindowStateChange && strip_ != nullptr)
    strip_->SetWindowMinimized(isMinimized());
}

void MainWindow::closeEvent(QCloseEvent* event) {
  if (desk_->state() == DeskState::kIdle) return event->accept();
  closes_when_idle_ = true;
  desk_->Stop();
  messages_->ShowNote(tr("Closing as soon as the session is complete …"));
  event->ignore();
}

void MainWindow::keyPressEvent(QKeyEvent* event) {
  if (const std::optional<double> step_mm = SpacingStepFor(*event)) {
    spacings_->StepActive(*step_mm);
  } else if (event->key() == Qt::Key_F) {
    view_->Fit();
  } else {
    QMainWindow::keyPressEvent(event);
  }
}

}  // namespace elbowroom::console
