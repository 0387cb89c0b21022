#include "app/console/layouts/layout_page.h"

#include <QHBoxLayout>
#include <QKeyEvent>
#include <QPushButton>
#include <QSplitter>
#include <QStandardPaths>
#include <QUrl>
#include <QVBoxLayout>
#include <algorithm>
#include <utility>

#include "app/console/desktop/theme.h"
#include "app/control/layout_editing/gap_line.h"
#include "app/control/layout_editing/layout_edit.h"
#include "app/control/layout_editing/pair_of_parts.h"
#include "cad_import/formats/file_format.h"

namespace elbowroom::console {
namespace {

constexpr int kSidePx = 330, kLeastSidePx = 300, kLeastListPx = 44;

std::filesystem::path UnsavedFolder() {
  return QStandardPaths::writableLocation(QStandardPaths::AppDataLocation).toStdString();
}

// Along the others a gap decides where the part stands.
std::array<bool, 3> FreeAxes(const core::Layout& layout, core::PartIndex part) {
  std::array<bool, 3> free = {true, true, true};
  for (const core::Spacing& spacing : layout.spacings) {
    const std::vector<core::PartIndex> moving = layout.PartsNamed(spacing.moving);
    if (std::ranges::find(moving, part) != moving.end())
      free.at(static_cast<std::size_t>(spacing.axis)) = false;
  }
  return free;
}

Eigen::Vector3f ColorVector(const QColor& color) { return {color.redF(), color.greenF(), color.blueF()}; }

// A nanometre, or a millionth of a degree: what a hand and a file need, without noise in the last digits.
Eigen::Vector3d Rounded(const Eigen::Vector3d& v) {
  constexpr double kFinest = 1e6;
  return (v * kFinest).array().round() / kFinest;
}

}  // namespace

LayoutPage::LayoutPage(QWidget* parent)
    : QWidget(parent),
      desk_(new LayoutDesk(UnsavedFolder(), this)),
      menu_(new QMenu(tr("&Layout"), this)),
      placing_(new PlacingSteps(this)) {
  view_ = new PartsView;
  view_->setObjectName("layout_view");
  view_->setAccessibleName(tr("Parts of the layout"));
  view_->SetEmptyText(
      tr("No parts yet.\nDrop a CAD file here (STEP, 3MF, STL, OBJ, glTF …), or press Import part …"));
  reading_ = new QProgressBar;
  reading_->setObjectName("layout_reading");
  reading_->setRange(0, 0);
  reading_->setMaximumHeight(16);
  AddActions();
  auto* split = new QSplitter(Qt::Horizontal);
  split->addWidget(view_);
  split->addWidget(SidePanel());
  split->setStretchFactor(0, 1);
  split->setSizes({1000, kSidePx});
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(4);
  column->addWidget(ButtonRow());
  recovery_ = new QuestionBar("recovery");
  unsaved_ = new QuestionBar("unsaved");
  column->addWidget(recovery_);
  column->addWidget(unsaved_);
  column->addWidget(reading_);
  column->addWidget(split, 1);
  FollowDesk();
  FollowPanels();
  FollowPlacing();
  reading_->hide();
  ShowLayout();
}

LayoutPage::~LayoutPage() = default;

QWidget* LayoutPage::SidePanel() {
  list_ = new PartsList;
  list_->setMinimumHeight(kLeastListPx);
  part_ = new PartPanel;
  part_->setObjectName("part_panel");
  rules_ = new RulePanel;
  rules_->setObjectName("rule_panel");
  auto* side = new QWidget;
  side->setMinimumWidth(kLeastSidePx);
  auto* column = new QVBoxLayout(side);
  column->setContentsMargins(0, 0, 0, 0);
  column->addWidget(list_, 3);
  column->addWidget(part_);
  column->addWidget(rules_, 4);
  return side;
}

void LayoutPage::FollowDesk() {
  connect(desk_, &LayoutDesk::Failed, this, &LayoutPage::Failed);
  connect(desk_, &LayoutDesk::Changed, this, &LayoutPage::ShowLayout);
  connect(desk_, &LayoutDesk::Opened, this, [this](bool has_file) {
    looks_.clear();
    chosen_.clear();
    ShowLayout();
    view_->Fit();
    if (has_file) emit LayoutSaved(QString::fromStdString(desk_->document().file().string()));
  });
  connect(desk_, &LayoutDesk::ReadingChanged, this, [this](const QString& what) {
    reading_->setVisible(!what.isEmpty());
    reading_->setFormat(what);
    if (what.isEmpty()) OfferRecovery();  // what couldn't be read is still offered
  });
}

void LayoutPage::FollowPanels() {
  connect(view_, &PartsView::Failed, this, &LayoutPage::Failed);
  connect(view_, &PartsView::Picked, this, [this](int part, bool adds) {
    const QString name =
        part < 0 ? QString() : QString::fromStdString(layout().parts[static_cast<std::size_t>(part)].name);
    Choose(WithClick(chosen_, name, adds));
  });
  connect(list_, &PartsList::Chosen, this, &LayoutPage::Choose);
  connect(list_, &PartsList::RenameAsked, this, &LayoutPage::RenamePart,
          Qt::QueuedConnection);  // once it is closed
  connect(list_, &PartsList::VisibilityChanged, this, [this](const QString& part, bool is_visible) {
    looks_[part].is_visible = is_visible;
    ShowParts();
  });
  connect(part_, &PartPanel::Moved, this, &LayoutPage::MovePart);
  connect(part_, &PartPanel::Turned, this, &LayoutPage::TurnPart);
  connect(part_, &PartPanel::RemoveAsked, this, &LayoutPage::RemovePart);
  connect(part_, &PartPanel::IsolateAsked, this, &LayoutPage::Isolate);
  connect(part_, &PartPanel::UndoAsked, desk_, &LayoutDesk::Undo);
  connect(part_, &PartPanel::RedoAsked, desk_, &LayoutDesk::Redo);
  connect(part_, &PartPanel::LookChanged, this, [this](const QString& part, const PartLook& look) {
    looks_[part] = look;
    ShowLayout();
  });
  connect(rules_, &RulePanel::SpacingAsked, this, [this] {
    AskForSpacing(
        control::ProposeSpacing(layout(), Poses(), chosen_[0].toStdString(), chosen_[1].toStdString()), true);
  });
  connect(rules_, &RulePanel::PairAsked, this, [this] {
    AskForPair(control::ProposePairRule(layout(), chosen_[0].toStdString(), chosen_[1].toStdString()));
  });
  connect(rules_, &RulePanel::SpacingChangeAsked, this,
          [this](std::size_t i) { AskForSpacing(layout().spacings[i], false); });
  connect(rules_, &RulePanel::PairChangeAsked, this,
          [this](std::size_t i) { AskForPair(layout().pair_rules[i]); });
  connect(rules_, &RulePanel::SpacingRemovalAsked, this, [this](std::size_t i) {
    Change(tr("Remove %1").arg(QString::fromStdString(layout().spacings[i].name)),
           [i](cad_import::LayoutText& text) { text.Remove("spacing", i); });
  });
  connect(rules_, &RulePanel::PairRemovalAsked, this, [this](std::size_t i) {
    Change(tr("Remove pair rule"), [i](cad_import::LayoutText& text) { text.Remove("pair", i); });
  });
}

void LayoutPage::FollowPlacing() {
  connect(placing_, &PlacingSteps::Changed, this, [this] { view_->SetAdvice(placing_->Advice()); });
  connect(placing_, &PlacingSteps::Failed, this, &LayoutPage::Failed);
  connect(placing_, &PlacingSteps::Placed, this, &LayoutPage::PlacePart);
  // What was clicked on first may be another part now, or stand elsewhere.
  connect(desk_, &LayoutDesk::Changed, this, [this] {
    const Placing placing = placing_->placing();
    if (placing == Placing::kFaceToFace || placing == Placing::kHoleToHole) placing_->Begin(placing);
  });
  connect(view_, &PartsView::PointPicked, this,
          [this](const control::Pick& pick) { placing_->Take(layout(), Poses(), pick); });
  connect(view_, &PartsView::Dragged, this, [this](int part, const core::RigidTransform& pose) {
    PlacePart(QString::fromStdString(layout().parts[static_cast<std::size_t>(part)].name), pose);
  });
}

std::vector<core::RigidTransform> LayoutPage::Poses() const {
  return core::PosesAt(layout(), layout().InitialSpacings());
}

void LayoutPage::Choose(const QStringList& parts) {
  chosen_ = parts;
  ShowLayout();
}

PartLook LayoutPage::LookOf(const QString& part) const {
  const auto found = looks_.find(part);
  return found == looks_.end() ? PartLook() : found->second;
}

void LayoutPage::ShowLayout() {
  chosen_.removeIf([this](const QString& part) { return !layout().FindPart(part.toStdString()); });
  ShowParts();
  list_->Show(layout(), looks_, chosen_);
  const QString first = chosen_.value(0);
  part_->Show(layout(), first.isEmpty() ? std::nullopt : layout().FindPart(first.toStdString()),
              LookOf(first));
  rules_->Show(layout(), chosen_);
  ShowState();
}

void LayoutPage::ShowParts() {
  const std::vector<core::RigidTransform> poses = Poses();
  std::vector<ShownPart> parts;
  for (core::PartIndex i = 0; i < layout().parts.size(); ++i) {
    const core::Part& part = layout().parts[i];
    const QString name = QString::fromStdString(part.name);
    const PartLook look = LookOf(name);
    parts.push_back({name, part.mesh, poses[i], ColorVector(look.color.isValid() ? look.color : PartColor(i)),
                     static_cast<float>(look.opacity), look.is_visible,
                     static_cast<int>(chosen_.indexOf(name)) + 1, FreeAxes(layout(), i)});
  }
  std::vector<ShownGap> gaps;
  for (const core::Spacing& spacing : layout().spacings) {
    const auto [from, to] = control::GapLine(layout(), spacing, poses);
    gaps.push_back({from, to,
                    tr("%1 %2 mm")
                        .arg(QString::fromStdString(spacing.name))
                        .arg(core::GapMm(layout(), spacing, poses), 0, 'g', 6)});
  }
  view_->Show(std::move(parts), std::move(gaps));
}

void LayoutPage::Change(const QString& name, const control::LayoutDocument::Change& change,
                        const QString& key) {
  const QString fault = desk_->Apply(name, change, key);
  if (fault.isEmpty()) return;
  emit Failed(fault);
  ShowLayout();  // what was entered isn't so
}

void LayoutPage::MovePart(const QString& part, int axis, double position_mm) {
  const auto index = layout().FindPart(part.toStdString());
  if (!index) return;
  control::PartEdit edit;
  edit.name = part.toStdString();
  edit.position_mm = layout().parts[*index].world_from_part.translation_mm;
  (*edit.position_mm)[axis] = position_mm;
  Change(
      tr("Move %1").arg(part), [edit](cad_import::LayoutText& text) { control::MovePart(text, edit); },
      "move " + part);
}

void LayoutPage::TurnPart(const QString& part, int axis, double rotation_deg) {
  const auto index = layout().FindPart(part.toStdString());
  if (!index) return;
  control::PartEdit edit;
  edit.name = part.toStdString();
  edit.rotation_rpy_deg = RollPitchYawDegOf(layout().parts[*index]);
  (*edit.rotation_rpy_deg)[axis] = rotation_deg;
  Change(
      tr("Turn %1").arg(part), [edit](cad_import::LayoutText& text) { control::MovePart(text, edit); },
      "turn " + part);
}

void LayoutPage::PlacePart(const QString& part, const core::RigidTransform& world_from_part) {
  core::Part placed;
  placed.file = "placed";  // FieldsOf asks for one
  placed.world_from_part = world_from_part;
  control::PartEdit edit;
  edit.name = part.toStdString();
  edit.position_mm = Rounded(world_from_part.translation_mm);
  edit.rotation_rpy_deg = Rounded(RollPitchYawDegOf(placed));
  Change(tr("Place %1").arg(part), [edit](cad_import::LayoutText& text) { control::MovePart(text, edit); });
}

void LayoutPage::RenamePart(const QString& part, const QString& to) {
  const PartLooks looks = looks_;
  const QStringList chosen = chosen_;
  if (const auto look = looks_.extract(part)) looks_[to] = look.mapped();
  std::ranges::replace(chosen_, part, to);
  const QString fault = desk_->Apply(
      tr("Rename %1").arg(part), [from = part.toStdString(), to = to.toStdString()](
                                     cad_import::LayoutText& text) { control::RenamePart(text, from, to); });
  if (fault.isEmpty()) return;
  looks_ = looks;
  chosen_ = chosen;
  emit Failed(fault);
  ShowLayout();
}

void LayoutPage::RemovePart(const QString& part) {
  Change(tr("Remove %1").arg(part),
         [name = part.toStdString()](cad_import::LayoutText& text) { control::RemoveWithUsers(text, name); });
}

void LayoutPage::Isolate(const QString& part) {
  const bool is_isolated = std::ranges::none_of(layout().parts, [&](const core::Part& other) {
    const QString name = QString::fromStdString(other.name);
    return LookOf(name).is_visible != (name == part);
  });
  for (const core::Part& other : layout().parts) {
    const QString name = QString::fromStdString(other.name);
    looks_[name].is_visible = is_isolated || name == part;
  }
  ShowLayout();
}

QString LayoutPage::CadFileIn(const QMimeData* data) {
  if (data == nullptr || data->urls().size() != 1) return {};
  const QString file = data->urls().front().toLocalFile();
  return cad_import::FindFormat(file.toStdString()) ? file : QString();
}

void LayoutPage::showEvent(QShowEvent* event) {
  QWidget::showEvent(event);
  view_->setFocus();
}

// The window's own shortcuts, of trials, would take the keys otherwise.
bool LayoutPage::event(QEvent* event) {
  if (event->type() == QEvent::ShortcutOverride) {
    const auto* key = static_cast<QKeyEvent*>(event);
    if (std::ranges::any_of(keys_, [&](const KeyAction& one) { return key->matches(one.key); })) {
      event->accept();
      return true;
    }
  }
  return QWidget::event(event);
}

void LayoutPage::keyPressEvent(QKeyEvent* event) {
  if (event->key() == Qt::Key_Escape && placing_->placing() != Placing::kNone) return placing_->End();
  const auto found =
      std::ranges::find_if(keys_, [&](const KeyAction& one) { return event->matches(one.key); });
  event->accept();  // whatever it is: the window's keys move the gaps of a trial that runs
  if (found != keys_.end()) found->action->trigger();
}

}  // namespace elbowroom::console
