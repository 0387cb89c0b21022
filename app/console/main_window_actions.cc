// The window's tool bar and menus.
#include <QActionGroup>
#include <QMenu>
#include <QMenuBar>
#include <QStyle>
#include <QToolBar>
#include <array>
#include <utility>

#include "app/console/camera_actions.h"
#include "app/console/desktop/recent_trials.h"
#include "app/console/desktop/theme.h"
#include "app/console/main_window.h"
#include "app/console/review_actions.h"
#include "app/console/reviews/recent_sessions.h"

namespace elbowroom::console {

void MainWindow::AddActions() {
  auto* bar = addToolBar(tr("Trial"));
  bar->setObjectName("trial_bar");
  bar->setMovable(false);
  bar->setToolButtonStyle(Qt::ToolButtonTextBesideIcon);
  auto* demo = new StartDemoAction(*desk_, place_, this);
  demo->setObjectName("start_demo");
  for (const control::Sample sample : control::kSamples) {
    const std::string_view name = control::ToString(sample);
    (new StartSampleAction(sample, *desk_, place_, this))
        ->setObjectName("sample:" + QString::fromUtf8(name.data(), static_cast<qsizetype>(name.size())));
  }
  auto* open = new OpenTrialAction(
      *desk_, [this](const QString& file) { StartTrial(file); }, this);
  open->setObjectName("open_trial");
  auto* calibrate = new CalibrateAction(*desk_, this);
  calibrate->setObjectName("calibrate");
  auto* stop = new StopAction(*desk_, this);
  stop->setObjectName("stop");
  auto* report = new ReportAction(*desk_, this);
  report->setObjectName("report");
  auto* review = new ReviewTrialAction(*desk_, this);
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
  TakeIcons();
  bar->addActions({demo, open});
  bar->addSeparator();
  bar->addActions({stop, report, review});
  bar->addSeparator();
  bar->addActions({undo, redo});
  bar->addSeparator();
  bar->addWidget(hull_look_);
}

void MainWindow::TakeIcons() {
  for (const auto& [name, standard] :
       {std::pair{"start_demo", QStyle::SP_MediaPlay}, std::pair{"stop", QStyle::SP_MediaStop}}) {
    if (auto* action = findChild<QAction*>(name))
      action->setIcon(InTextColor(style()->standardIcon(standard)));
  }
}

void MainWindow::AddMenus() {
  const auto action = [this](const char* name) { return findChild<QAction*>(name); };
  auto* file = menuBar()->addMenu(tr("&File"));
  file->setToolTipsVisible(true);
  file->addAction(action("open_trial"));
  auto* recent = new RecentTrialsMenu(this);
  recent->setObjectName("recent_trials");
  connect(recent, &RecentTrialsMenu::Chosen, this, &MainWindow::OpenFile);
  file->addMenu(recent);
  file->addAction(new OpenSessionAction(this));
  auto* sessions = new RecentSessionsMenu(this);
  sessions->setObjectName("recent_sessions");
  connect(sessions, &RecentSessionsMenu::Chosen, this,
          [this](const QString& session) { OpenSession(session.toStdString()); });
  file->addMenu(sessions);
  file->addAction(new SessionsFolderAction(this));
  file->addSeparator();
  QAction* quit = file->addAction(tr("&Quit"), QKeySequence::Quit, this, &QWidget::close);
  quit->setToolTip(tr("A running trial ends in order first"));
  auto* trial = menuBar()->addMenu(tr("&Trial"));
  trial->setToolTipsVisible(true);
  trial->addActions({action("start_demo"), action("stop"), action("report"), action("review_trial")});
  auto* samples = trial->addMenu(tr("Sa&mples"));
  samples->setToolTipsVisible(true);
  samples->addActions({action("sample:payload"), action("sample:curtain"), action("sample:faucet")});
  trial->addSeparator();
  trial->addActions({action("undo_gap"), action("redo_gap")});
  trial->addSeparator();
  trial->addActions(procedure_->actions());
  trial->addAction(tr("N&ote"), QKeySequence(Qt::CTRL | Qt::Key_N), note_,
                   [this] { note_->setFocus(Qt::ShortcutFocusReason); });
  auto* cameras = menuBar()->addMenu(tr("&Cameras"));
  cameras->setToolTipsVisible(true);
  cameras->addActions({action("show_preflight"), action("take_background"), action("calibrate")});
  auto* view = menuBar()->addMenu(tr("&View"));
  view->addAction(tr("&Fit everything"), QKeySequence(Qt::Key_F), this, [this] {
    if (pages_->page() == Page::kReview) return review_page_->Fit();
    view_->Fit();
  });
  sights_->AddTo(view);
  auto* hull = view->addMenu(tr("&Hull"));
  hull->setToolTipsVisible(true);
  for (QAction* look : hull_look_->KnowledgeActions()) hull->addAction(look);
  view->addSeparator();
  view->addAction(tr("F&ull screen"), QKeySequence(Qt::Key_F11), this,
                  [this] { setWindowState(windowState() ^ Qt::WindowFullScreen); });
  view->addMenu(ThemeMenu());
  view->addSeparator();
  for (const QDockWidget* dock : findChildren<QDockWidget*>())
    if (dock != preflight_dock_) view->addAction(dock->toggleViewAction());
  AddParticipant();
}

void MainWindow::AddParticipant() {
  participant_ = new ParticipantDesk(this);
  menuBar()->addMenu(participant_->menu());
  status_->AddGuest(participant_->status());
  connect(participant_, &ParticipantDesk::Failed, this, &MainWindow::ShowError);
  connect(hull_look_, &HullLookButton::Chosen, participant_, &ParticipantDesk::SetLook);
  connect(desk_, &TrialDesk::TrialOpened, participant_,
          [this](const control::TrialSetup& setup) { participant_->OpenTrial(setup.source->rig()); });
  connect(desk_, &TrialDesk::FrameArrived, participant_,
          [this](const FrameNews& news) { participant_->ShowFrame(news.result); });
}

QMenu* MainWindow::ThemeMenu() {
  auto* menu = new QMenu(tr("&Colours"), this);
  auto* group = new QActionGroup(this);
  const std::array names = {tr("As the &desktop"), tr("&Light"), tr("D&ark")};
  for (std::size_t i = 0; i < kThemes.size(); ++i) {
    QAction* choice = menu->addAction(names.at(i));
    choice->setObjectName("theme:" + KeyOf(kThemes.at(i)));
    choice->setCheckable(true);
    choice->setChecked(kThemes.at(i) == CurrentTheme());
    group->addAction(choice);
    connect(choice, &QAction::triggered, this, [theme = kThemes.at(i)] {
      SetTheme(theme);
      RememberTheme(theme);
    });
  }
  return menu;
}

}  // namespace elbowroom::console
