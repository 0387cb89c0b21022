#include "app/console/sights/section_panel.h"

#include <QGridLayout>
#include <QHBoxLayout>
#include <QSettings>
#include <QSignalBlocker>
#include <QVBoxLayout>
#include <algorithm>
#include <cmath>
#include <utility>

#include "app/control/layout_editing/section_file.h"

namespace elbowroom::console {
namespace {

using control::Section;
using Eigen::Vector3d;

constexpr const char* kSettingsKey = "section/planes";
constexpr int kListPx = 150, kLinesInList = 4;
constexpr int kLongestName = 60;
constexpr double kUprightDeg =
    89.995;  // of elevation: from here on it is shown as 90, and any azimuth will do

double Support(const Eigen::AlignedBox3d& box, const Vector3d& direction) {
  return direction.dot(box.center()) + direction.cwiseAbs().dot(0.5 * box.sizes());
}

}  // namespace

SectionPanel::SectionPanel(QWidget* parent) : QWidget(parent) {
  setObjectName("section_panel");
  workspace_mm_ = {Vector3d::Constant(-500.0), Vector3d::Constant(500.0)};
  MakeList();
  MakeNumbers();
  MakeButtons();
  auto* numbers = new QHBoxLayout;
  for (QWidget* widget : std::initializer_list<QWidget*>{name_, slider_, offset_mm_, flip_})
    numbers->addWidget(widget, widget == slider_ ? 2 : widget == name_ ? 1 : 0);
  auto* angles = new QHBoxLayout;
  for (QWidget* widget : std::initializer_list<QWidget*>{azimuth_deg_, elevation_deg_, align_})
    angles->addWidget(widget);
  angles->addStretch(1);
  auto* steps = new QHBoxLayout;
  for (QWidget* widget : std::initializer_list<QWidget*>{add_, remove_, undo_, redo_, save_})
    steps->addWidget(widget);
  steps->addWidget(state_, 1);
  auto* right = new QVBoxLayout;
  right->setSpacing(2);
  right->addLayout(numbers);
  right->addLayout(angles);
  right->addLayout(steps);
  auto* row = new QHBoxLayout(this);
  row->setContentsMargins(0, 0, 0, 0);
  row->addWidget(planes_);
  row->addLayout(right, 1);
  hide();
  Open(workspace_mm_);
}

SectionPanel::~SectionPanel() = default;

void SectionPanel::MakeList() {
  planes_ = new QListWidget;
  planes_->setObjectName("section_list");
  planes_->setAccessibleName(tr("Section planes"));
  planes_->setToolTip(tr("A tick: parts and hull are cut open there. Click on one to change it"));
  planes_->setFocusPolicy(Qt::TabFocus);  // a click leaves the keys to the trial
  planes_->setFixedWidth(kListPx);
  planes_->setFixedHeight(kLinesInList * (planes_->fontMetrics().height() + 6));
  connect(planes_, &QListWidget::currentRowChanged, this, &SectionPanel::Choose);
  connect(planes_, &QListWidget::itemChanged, this, [this](const QListWidgetItem* item) {
    const auto row = static_cast<std::size_t>(planes_->row(item));
    std::vector<Section> next = sections();
    if (row >= next.size()) return;
    next[row].is_on = item->checkState() == Qt::Checked;
    active_ = row;
    Change(std::move(next));
  });
}

QDoubleSpinBox* SectionPanel::Number(const char* name, const QString& spoken, const QString& tool_tip,
                                     double most, const QString& suffix) {
  auto* number = new QDoubleSpinBox;
  number->setObjectName(name);
  number->setAccessibleName(spoken);
  number->setToolTip(tool_tip);
  number->setRange(-most, most);
  number->setSuffix(suffix);
  connect(number, &QDoubleSpinBox::valueChanged, this, &SectionPanel::TakeNumbers);
  connect(number, &QDoubleSpinBox::editingFinished, this, &SectionPanel::EndStep);
  return number;
}

void SectionPanel::MakeNumbers() {
  name_ = new QLineEdit;
  name_->setObjectName("section_name");
  name_->setAccessibleName(tr("Name of the section plane"));
  name_->setToolTip(tr("Under which the plane is listed and saved; Enter gives it that name"));
  name_->setMaxLength(kLongestName);
  name_->setMinimumWidth(90);
  connect(name_, &QLineEdit::editingFinished, this, &SectionPanel::TakeName);
  connect(name_, &QLineEdit::returnPressed, this, [this] { setFocus(); });  // the keys are the trial's again
  slider_ = new QSlider(Qt::Horizontal);
  slider_->setObjectName("section_slider");
  slider_->setAccessibleName(tr("Place of the plane along its normal, mm"));
  slider_->setToolTip(
      tr("Place of the plane along its normal, mm; in the 3-D view: drag its arrow, or drag with Shift"));
  slider_->setMinimumWidth(80);
  connect(slider_, &QSlider::valueChanged, this, [this](int at_mm) { offset_mm_->setValue(at_mm); });
  connect(slider_, &QSlider::sliderReleased, this, &SectionPanel::EndStep);
  offset_mm_ = Number("section_mm", slider_->accessibleName(), slider_->toolTip(), 1e5, tr(" mm"));
  offset_mm_->setDecimals(1);
  azimuth_deg_ = Number("section_azimuth", tr("Azimuth of the plane's normal, degrees"),
                        tr("Where the normal points about the world's Z axis, degrees from X; 90 is along Y"),
                        180.0, tr("°"));
  azimuth_deg_->setPrefix(tr("azimuth "));
  azimuth_deg_->setWrapping(true);
  elevation_deg_ = Number("section_elevation", tr("Elevation of the plane's normal, degrees"),
                          tr("How far the normal points up, degrees; 90 is along Z"), 90.0, tr("°"));
  elevation_deg_->setPrefix(tr("elevation "));
}

QToolButton* SectionPanel::Button(const char* name, const QString& text, const QString& tool_tip) {
  auto* button = new QToolButton;
  button->setObjectName(name);
  button->setText(text);
  button->setAccessibleName(tool_tip);
  button->setToolTip(tool_tip);
  return button;
}

QMenu* SectionPanel::AddMenu() {
  auto* menu = new QMenu(this);
  for (int axis = 0; axis < 3; ++axis) {
    const QString name = tr("Across %1").arg(QChar('X' + axis));
    QAction* action = menu->addAction(name);
    action->setObjectName(QString("section_add:") + QChar('x' + axis));
    connect(action, &QAction::triggered, this,
            [this, axis, name] { Add(name, Vector3d(Vector3d::Unit(axis)), workspace_mm_.center()); });
  }
  QAction* facing = menu->addAction(tr("Facing the view"));
  facing->setObjectName("section_add:view");
  connect(facing, &QAction::triggered, this, &SectionPanel::FacingAsked);
  return menu;
}

void SectionPanel::MakeButtons() {
  flip_ = Button("section_flip", tr("Flip"), tr("Keep the other side of the plane (Alt+X)"));
  flip_->setShortcut(QKeySequence(Qt::ALT | Qt::Key_X));  // its letters are the menus'
  align_ =
      Button("section_align", tr("Ali&gn to face"),
             tr("Then click on a face of a part in the 3-D view: the plane takes its place and direction"));
  align_->setCheckable(true);
  add_ = Button("section_add", tr("A&dd"), tr("Add a section plane"));
  add_->setMenu(AddMenu());
  add_->setPopupMode(QToolButton::InstantPopup);
  remove_ = Button("section_remove", tr("Re&move"), tr("Remove the section plane"));
  undo_ = Button("section_undo", tr("&Undo"), tr("Undo the last change of the section planes"));
  redo_ = Button("section_redo", tr("R&edo"), tr("Redo the change of the section planes that was undone"));
  save_ = Button("section_save", tr("Save in la&yout"), tr("Save the section planes in the layout's file"));
  state_ = new QLabel;
  state_->setObjectName("section_state");
  state_->setForegroundRole(QPalette::PlaceholderText);
  state_->setTextFormat(Qt::PlainText);
  state_->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Preferred);
  connect(flip_, &QToolButton::clicked, this, [this] {
    std::vector<Section> next = sections();
    next[active_] = control::Flipped(next[active_]);
    Change(std::move(next));
  });
  connect(align_, &QToolButton::toggled, this, &SectionPanel::AlignAsked);
  connect(remove_, &QToolButton::clicked, this, &SectionPanel::Remove);
  connect(undo_, &QToolButton::clicked, this, [this] {
    list_.Undo();
    Show();
  });
  connect(redo_, &QToolButton::clicked, this, [this] {
    list_.Redo();
    Show();
  });
  connect(save_, &QToolButton::clicked, this, &SectionPanel::Save);
}

std::vector<Section> SectionPanel::FirstSections() const {
  std::vector<Section> sections;
  for (int axis = 0; axis < 3; ++axis) {
    // The eye is in front at first, so that what is behind stays.
    const Vector3d normal = (axis == 1 ? -1.0 : 1.0) * Vector3d::Unit(axis);
    sections.push_back({tr("Across %1").arg(QChar('X' + axis)).toStdString(), normal + Vector3d::Zero(),
                        normal.dot(workspace_mm_.center()), false});
  }
  return sections;
}

void SectionPanel::Open(const Eigen::AlignedBox3d& workspace_mm, const std::filesystem::path& layout_file,
                        const std::vector<Section>& sections) {
  workspace_mm_ = workspace_mm;
  layout_file_ = layout_file;
  saved_ = sections;
  std::vector<Section> first =
      layout_file.empty() ? control::SectionsFrom(QSettings().value(kSettingsKey).toString().toStdString())
                          : sections;
  if (first.empty()) first = saved_ = FirstSections();
  list_ = control::SectionList(std::move(first));
  active_ = 0;
  SetAligning(false);
  Show();
}

control::SectionCut SectionPanel::cut() const {
  return isHidden() ? control::SectionCut() : control::CutOf(sections());
}

std::optional<Section> SectionPanel::active() const {
  if (isHidden() || active_ >= sections().size() || !sections()[active_].is_on) return std::nullopt;
  return sections()[active_];
}

void SectionPanel::SetActive(const Section& section) {
  std::vector<Section> next = sections();
  next[active_] = section;
  Change(std::move(next), "drag " + section.name);
}

void SectionPanel::Drag(const Vector3d& by_in_world_mm) {
  std::optional<Section> section = active();
  if (!section) return;
  section->offset_mm += control::HalfSpaceOf(*section).outward.dot(by_in_world_mm);
  SetActive(*section);
}

void SectionPanel::Add(const QString& wanted_name, const Vector3d& normal, const Vector3d& x_in_world) {
  std::vector<Section> next = sections();
  if (next.size() >= control::kMostSections)
    return emit Failed(tr("There are %1 section planes already: remove one first").arg(next.size()));
  Section section;
  section.name = control::FreeSectionName(next, wanted_name.toStdString());
  next.push_back(control::TurnedThrough(section, normal, x_in_world));
  active_ = next.size() - 1;
  Change(std::move(next));
}

void SectionPanel::Remove() {
  std::vector<Section> next = sections();
  next.erase(next.begin() + static_cast<std::ptrdiff_t>(active_));
  Change(std::move(next));
}

void SectionPanel::TakeName() {
  std::vector<Section> next = sections();
  const std::string wanted = name_->text().trimmed().toStdString();
  name_->setModified(false);
  if (active_ >= next.size() || wanted == next[active_].name) return;
  if (wanted.empty()) return ShowActive();
  next[active_].name.clear();
  next[active_].name = control::FreeSectionName(next, wanted);
  Change(std::move(next));
}

void SectionPanel::TakeNumbers() {
  std::vector<Section> next = sections();
  if (active_ >= next.size()) return;
  Section& section = next[active_];
  if (sender() == offset_mm_) {
    section.offset_mm = offset_mm_->value();
  } else {
    control::PlaneAngles angles = control::AnglesOf(section.normal);
    const bool is_upright = std::abs(angles.elevation_deg) > kUprightDeg;
    if (sender() == azimuth_deg_ || is_upright) angles.azimuth_deg = azimuth_deg_->value();
    if (sender() == elevation_deg_) angles.elevation_deg = elevation_deg_->value();
    // It turns about where it is in the middle of the workspace.
    const recon::HalfSpace half_space = control::HalfSpaceOf(section);
    const Vector3d center = workspace_mm_.center();
    section = control::TurnedThrough(section, control::NormalAt(angles),
                                     center - half_space.BeyondMm(center) * half_space.outward);
  }
  section.is_on = true;
  Change(std::move(next), sender()->objectName().toStdString() + " of " + section.name);
}

void SectionPanel::Change(std::vector<Section> next, const std::string& merge_key) {
  list_.Change(std::move(next), merge_key);
  if (merge_key.empty()) list_.EndStep();
  Show();
}

void SectionPanel::Choose(int row) {
  if (row < 0 || active_ == static_cast<std::size_t>(row)) return;
  TakeName();  // that was being typed for the one before
  active_ = static_cast<std::size_t>(row);
  list_.EndStep();
  Show();
}

void SectionPanel::Show() {
  const std::vector<Section>& now = sections();
  active_ = std::min(active_, now.empty() ? 0 : now.size() - 1);
  {
    const QSignalBlocker quiet(planes_);
    while (planes_->count() > static_cast<int>(now.size())) delete planes_->takeItem(planes_->count() - 1);
    while (planes_->count() < static_cast<int>(now.size())) planes_->addItem(new QListWidgetItem);
    for (std::size_t i = 0; i < now.size(); ++i) {
      QListWidgetItem* item = planes_->item(static_cast<int>(i));
      item->setFlags(Qt::ItemIsEnabled | Qt::ItemIsSelectable | Qt::ItemIsUserCheckable);
      item->setText(QString::fromStdString(now[i].name));
      item->setCheckState(now[i].is_on ? Qt::Checked : Qt::Unchecked);
    }
    planes_->setCurrentRow(now.empty() ? -1 : static_cast<int>(active_));
  }
  ShowActive();
  Remember();
  emit Changed(cut());
}

void SectionPanel::ShowActive() {
  const bool has_one = active_ < sections().size();
  for (QWidget* widget : std::initializer_list<QWidget*>{name_, slider_, offset_mm_, azimuth_deg_,
                                                         elevation_deg_, flip_, align_, remove_})
    widget->setEnabled(has_one);
  undo_->setEnabled(list_.CanUndo());
  redo_->setEnabled(list_.CanRedo());
  const bool has_file = !layout_file_.empty(), is_saved = sections() == saved_;
  save_->setVisible(has_file);
  save_->setEnabled(has_file && !is_saved && !saving_);
  state_->setText(!has_file ? QString() : saving_ ? tr("saving …") : is_saved ? QString() : tr("not saved"));
  if (!has_one) return;
  const Section& section = sections()[active_];
  const recon::HalfSpace half_space = control::HalfSpaceOf(section);
  const control::PlaneAngles angles = control::AnglesOf(section.normal);
  const QSignalBlocker blockers[] = {QSignalBlocker(slider_), QSignalBlocker(offset_mm_),
                                     QSignalBlocker(azimuth_deg_), QSignalBlocker(elevation_deg_)};
  if (!(name_->hasFocus() && name_->isModified())) name_->setText(QString::fromStdString(section.name));
  slider_->setRange(static_cast<int>(std::floor(-Support(workspace_mm_, -half_space.outward))),
                    static_cast<int>(std::ceil(Support(workspace_mm_, half_space.outward))));
  slider_->setValue(static_cast<int>(std::lround(section.offset_mm)));
  offset_mm_->setValue(section.offset_mm);
  elevation_deg_->setValue(angles.elevation_deg);
  if (std::abs(angles.elevation_deg) <= kUprightDeg) azimuth_deg_->setValue(angles.azimuth_deg);
}

void SectionPanel::Save() {
  if (saving_ || layout_file_.empty()) return;
  const std::vector<Section> sections = this->sections();
  saving_ = std::make_unique<BackgroundJob>(
      bridge_,
      [file = layout_file_, sections](const std::stop_token&) { control::SaveSections(file, sections); },
      [this, file = layout_file_, sections](const std::string& error) {
        saving_.reset();
        if (!error.empty()) emit Failed(QString::fromStdString(error));
        if (error.empty() && file == layout_file_) saved_ = sections;
        ShowActive();
      });
  ShowActive();
}

void SectionPanel::SetAligning(bool is_on) { align_->setChecked(is_on); }

void SectionPanel::Remember() const {
  if (layout_file_.empty())
    QSettings().setValue(kSettingsKey, QString::fromStdString(control::TextOf(sections())));
}

void SectionPanel::showEvent(QShowEvent* event) {
  QWidget::showEvent(event);
  emit Changed(cut());
}

void SectionPanel::hideEvent(QHideEvent* event) {
  QWidget::hideEvent(event);
  if (!isHidden()) return;
  SetAligning(false);
  emit Changed(cut());
}

}  // namespace elbowroom::console
