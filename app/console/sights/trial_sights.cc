#include "app/console/sights/trial_sights.h"

#include <QHBoxLayout>
#include <QVBoxLayout>
#include <array>
#include <utility>

#include "app/control/layers/hull_colors.h"

namespace elbowroom::console {
namespace {

using recon::StandardView;

struct NamedView {
  StandardView view;
  const char* name;
  const char* key;
  const char* object_name;
};

constexpr std::array kViews = {
    NamedView{StandardView::kFront, QT_TRANSLATE_NOOP("elbowroom::console::TrialSights", "From the &front"),
              "Alt+1", "view_front"},
    NamedView{StandardView::kBack, QT_TRANSLATE_NOOP("elbowroom::console::TrialSights", "From the &back"),
              "Alt+2", "view_back"},
    NamedView{StandardView::kLeft, QT_TRANSLATE_NOOP("elbowroom::console::TrialSights", "From the &left"),
              "Alt+3", "view_left"},
    NamedView{StandardView::kRight, QT_TRANSLATE_NOOP("elbowroom::console::TrialSights", "From the &right"),
              "Alt+4", "view_right"},
    NamedView{StandardView::kTop, QT_TRANSLATE_NOOP("elbowroom::console::TrialSights", "From the &top"),
              "Alt+5", "view_top"},
    NamedView{StandardView::kBottom, QT_TRANSLATE_NOOP("elbowroom::console::TrialSights", "From b&elow"),
              "Alt+6", "view_bottom"},
    NamedView{StandardView::kIsometric, QT_TRANSLATE_NOOP("elbowroom::console::TrialSights", "&Isometric"),
              "Alt+7", "view_isometric"}};

QToolButton* MenuButton(const QString& text, const QString& tool_tip, const QString& name, QMenu* menu) {
  auto* button = new QToolButton;
  button->setText(text);
  button->setToolTip(tool_tip);
  button->setAccessibleName(text);
  button->setObjectName(name);
  button->setMenu(menu);
  button->setPopupMode(QToolButton::InstantPopup);
  button->setAutoRaise(true);
  return button;
}

QToolButton* ButtonOf(QAction* action) {
  auto* button = new QToolButton;
  button->setDefaultAction(action);
  button->setAccessibleName(action->iconText());
  button->setObjectName(action->objectName() + "_button");
  button->setAutoRaise(true);
  return button;
}

}  // namespace

TrialSights::TrialSights(OperatorView* view, QWidget* parent)
    : QWidget(parent),
      view_(view),
      camera_view_(new CameraView),
      stack_(new QStackedWidget),
      section_panel_(new SectionPanel),
      picker_(new PartPicker(view, this)),
      section_tool_(new SectionTool(section_panel_, view, picker_, this)),
      measure_(new MeasureTool(view, picker_, this)),
      advice_(new QLabel) {
  stack_->addWidget(view_);
  stack_->addWidget(camera_view_);
  MakeViewActions();
  MakeSectionAction();
  MakeHeatAction();
  FollowMeasure();
  cameras_ = new QMenu(tr("&Camera's view"), this);
  MakeBar();
  connect(camera_view_, &CameraView::Closed, this, &TrialSights::ShowScene);
  connect(camera_view_, &CameraView::RoomChanged, this, [this] {
    if (wishes_.enlarged) TellWishes();
  });
}

void TrialSights::MakeViewActions() {
  for (const NamedView& named : kViews) {
    auto* action = new QAction(tr(named.name), this);
    action->setObjectName(named.object_name);
    action->setShortcut(QKeySequence(named.key));
    action->setToolTip(tr("Look along an axis of the world"));
    connect(action, &QAction::triggered, this, [this, which = named.view] {
      ShowScene();
      view_->LookAlong(which);
    });
    standard_.push_back(action);
  }
  parallel_ = new QAction(tr("&Parallel projection"), this);
  parallel_->setObjectName("view_parallel");
  parallel_->setCheckable(true);
  parallel_->setShortcut(QKeySequence(Qt::Key_O));
  parallel_->setToolTip(tr("Equal lengths look equally long, near and far, as on a drawing"));
  connect(parallel_, &QAction::toggled, view_, &OperatorView::SetParallel);
  parts_ = new QAction(tr("P&arts in the cameras' pictures"), this);
  parts_->setObjectName("parts_in_pictures");
  parts_->setIconText(tr("Parts in pictures"));  // its button's
  parts_->setCheckable(true);
  parts_->setChecked(true);
  parts_->setShortcut(QKeySequence(Qt::Key_P));
  parts_->setToolTip(
      tr("Draw the virtual parts into the cameras' pictures, hidden by what is real before them"));
  connect(parts_, &QAction::toggled, this, [this](bool is_on) {
    wishes_.shows_parts = is_on;
    TellWishes();
  });
}

void TrialSights::MakeSectionAction() {
  section_ = new QAction(tr("&Section"), this);
  section_->setObjectName("section");
  section_->setCheckable(true);
  section_->setShortcut(QKeySequence(Qt::Key_X));
  section_->setToolTip(tr("Cut parts and hull open in the 3-D view"));
  connect(section_, &QAction::toggled, section_panel_, &SectionPanel::setVisible);
  connect(section_panel_, &SectionPanel::Failed, this, &TrialSights::Failed);
  connect(picker_, &PartPicker::Failed, this, &TrialSights::Failed);
}

void TrialSights::MakeHeatAction() {
  heat_ = new QAction(tr("&Heat"), this);
  heat_->setObjectName("heat");
  heat_->setCheckable(true);
  heat_->setShortcut(QKeySequence(Qt::Key_H));
  heat_->setToolTip(tr("Colour the parts by how long each place was touched so far, in s"));
  connect(heat_, &QAction::toggled, this, [this](bool is_on) {
    if (!is_on) view_->SetHeat(nullptr);
    emit HeatWished(is_on);
  });
}

void TrialSights::ShowHeat(const control::SharedHeatLayer& heat) {
  if (heat_->isChecked()) view_->SetHeat(heat, tr("this trial, so far"));
}

void TrialSights::FollowMeasure() {
  advice_->setObjectName("measure_advice");
  advice_->setAccessibleName(tr("What to click on next"));
  const auto advise = [this](const QString& line) {
    if (!line.isEmpty()) ShowScene();
    advice_->setText(line);
  };
  connect(measure_, &MeasureTool::Advised, this, advise);
  connect(measure_, &MeasureTool::Failed, this, &TrialSights::Failed);
  connect(section_tool_, &SectionTool::Advised, this, [this, advise](const QString& line) {
    if (!line.isEmpty()) measure_->End();
    advise(line);
  });
  connect(measure_, &MeasureTool::Begun, section_panel_, [this] { section_panel_->SetAligning(false); });
}

void TrialSights::ShowFrame(const control::SharedFrameResult& result) { measure_->ShowFrame(result); }

void TrialSights::MakeBar() {
  auto* views = new QMenu(this);
  for (QAction* action : standard_) views->addAction(action);
  views->addSeparator();
  views->addAction(parallel_);
  auto* bar = new QHBoxLayout;
  bar->setContentsMargins(0, 0, 0, 0);
  bar->setSpacing(2);
  bar->addWidget(MenuButton(tr("View"), tr("Standard views and projection"), "view_menu", views));
  bar->addWidget(
      MenuButton(tr("Camera"), tr("Look from a camera, or at its picture"), "camera_menu", cameras_));
  bar->addWidget(ButtonOf(parts_));
  bar->addWidget(ButtonOf(section_));
  bar->addWidget(ButtonOf(heat_));
  auto* measure = new QMenu(this);
  for (QAction* action : measure_->actions()) measure->addAction(action);
  bar->addWidget(MenuButton(tr("Measure"), tr("Lengths, angles, and the distance to the hull"),
                            "measure_menu", measure));
  bar->addSpacing(8);
  bar->addWidget(advice_);
  bar->addStretch(1);
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(2);
  column->addLayout(bar);
  column->addWidget(section_panel_);
  column->addWidget(stack_, 1);
}

void TrialSights::AddTo(QMenu* menu) {
  for (QAction* action : standard_) menu->addAction(action);
  menu->addAction(parallel_);
  menu->addAction(section_);
  menu->addAction(heat_);
  auto* measure = menu->addMenu(tr("&Measure"));
  for (QAction* action : measure_->actions()) measure->addAction(action);
  menu->addSeparator();
  menu->addMenu(cameras_);
  menu->addAction(parts_);
}

void TrialSights::Open(const control::TrialSetup& setup) {
  const core::Rig& rig = setup.source->rig();
  rig_ = rig.cameras;
  view_->SetKnowledge(control::KnowledgeOf(rig, setup.rig_quality));
  view_->SetHeat(nullptr);  // of another trial
  measure_->Clear();
  picker_->Forget();
  section_panel_->Open(rig.workspace_mm, setup.layout_file, setup.sections);
  MakeCameraMenu();
  ShowScene();
}

void TrialSights::MakeCameraMenu() {
  cameras_->clear();
  for (std::size_t i = 0; i < rig_.size(); ++i) {
    const QString name = QString::fromStdString(rig_[i].name());
    QAction* picture = cameras_->addAction(tr("Picture of %1").arg(name));
    picture->setObjectName("camera_picture:" + name);
    connect(picture, &QAction::triggered, this, [this, i] { ShowCamera(static_cast<int>(i)); });
  }
  cameras_->addSeparator();
  for (std::size_t i = 0; i < rig_.size(); ++i) {
    const QString name = QString::fromStdString(rig_[i].name());
    QAction* scene = cameras_->addAction(tr("3-D view from %1").arg(name));
    scene->setObjectName("camera_scene:" + name);
    connect(scene, &QAction::triggered, this, [this, i] {
      ShowScene();
      view_->LookFrom(rig_[i]);
    });
  }
}

void TrialSights::ShowTiles(const control::SharedTiles& tiles) {
  if (wishes_.enlarged && *wishes_.enlarged < tiles->size())
    camera_view_->ShowTile((*tiles)[*wishes_.enlarged]);
}

void TrialSights::SetTileRoom(const control::ThumbnailRoom& room) {
  wishes_.room = room;
  TellWishes();
}

void TrialSights::ShowCamera(int camera) {
  if (camera < 0 || static_cast<std::size_t>(camera) >= rig_.size()) return;
  wishes_.enlarged = static_cast<core::CameraIndex>(camera);
  camera_view_->Open(QString::fromStdString(rig_[*wishes_.enlarged].name()));
  stack_->setCurrentWidget(camera_view_);
  camera_view_->setFocus();
  TellWishes();
}

void TrialSights::ShowScene() {
  stack_->setCurrentWidget(view_);
  if (!std::exchange(wishes_.enlarged, std::nullopt)) return;
  view_->setFocus();
  TellWishes();
}

void TrialSights::TellWishes() {
  wishes_.enlarged_room = camera_view_->Room();
  emit WishesChanged(wishes_);
}

}  // namespace elbowroom::console
