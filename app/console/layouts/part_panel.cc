#include "app/console/layouts/part_panel.h"

#include <QColorDialog>
#include <QGridLayout>
#include <QHBoxLayout>
#include <QKeyEvent>
#include <QSignalBlocker>
#include <QVBoxLayout>
#include <algorithm>

#include "cad_import/layout/layout_fields.h"
#include "core/size_text.h"

namespace elbowroom::console {
namespace {

// Of names for scripts and tests, in no language.
constexpr std::array kAxisKeys = {"x", "y", "z"};
constexpr std::array kTurnKeys = {"roll", "pitch", "yaw"};
constexpr double kFarMm = 1e6, kManyTurnsDeg = 36'000.0;
constexpr std::array kStepsMm = {0.1, 1.0, 5.0, 10.0, 50.0};
constexpr std::array kStepsDeg = {0.1, 1.0, 5.0, 15.0, 45.0, 90.0};

QDoubleSpinBox* NumberBox(const QString& name, const QString& tool_tip, double most, const QString& suffix,
                          QObject* filter) {
  auto* box = new QDoubleSpinBox;
  box->setObjectName(name);
  box->setAccessibleName(tool_tip);
  box->setToolTip(tool_tip);
  box->setRange(-most, most);
  box->setDecimals(3);
  box->setSuffix(suffix);
  box->setKeyboardTracking(false);  // a number that is half typed moves nothing
  box->installEventFilter(filter);
  return box;
}

template <typename Steps>
QComboBox* StepBox(const QString& name, const QString& spoken, const Steps& steps, const QString& unit,
                   int chosen) {
  auto* box = new QComboBox;
  box->setObjectName(name);
  box->setAccessibleName(spoken);
  box->setToolTip(QObject::tr("By how much an arrow of a number changes it"));
  for (const double step : steps) box->addItem(QObject::tr("± %1 %2").arg(step).arg(unit), step);
  box->setCurrentIndex(chosen);
  return box;
}

QPixmap Square(const QColor& color) {
  QPixmap square(14, 14);
  square.fill(color);
  return square;
}

}  // namespace

Eigen::Vector3d RollPitchYawDegOf(const core::Part& part) {
  core::Layout layout;
  layout.parts = {part};
  const std::vector<cad_import::Fields> fields = cad_import::FieldsOf(layout, "part");
  const cad_import::FieldValue* value = cad_import::FindField(fields.front(), "rotation_rpy_deg");
  const auto* rotation = value == nullptr ? nullptr : std::get_if<Eigen::Vector3d>(value);
  return rotation == nullptr ? Eigen::Vector3d(Eigen::Vector3d::Zero()) : *rotation;
}

PartPanel::PartPanel(QWidget* parent) : QGroupBox(tr("Chosen part"), parent) {
  what_ = new QLabel;
  what_->setObjectName("part_what");
  what_->setWordWrap(true);
  what_->setTextFormat(Qt::PlainText);
  auto* column = new QVBoxLayout(this);
  column->setSpacing(4);
  column->addWidget(what_);
  column->addWidget(NumberRows());
  column->addWidget(LookRow());
  TakeSteps();
}

QWidget* PartPanel::NumberRows() {
  auto* rows = new QWidget;
  auto* grid = new QGridLayout(rows);
  grid->setContentsMargins(0, 0, 0, 0);
  grid->setVerticalSpacing(2);
  step_mm_ = StepBox("part_step_mm", tr("Step of the position, mm"), kStepsMm, tr("mm"), 3);
  step_deg_ = StepBox("part_step_deg", tr("Step of the turns, degrees"), kStepsDeg, tr("°"), 2);
  grid->addWidget(step_mm_, 0, 1);
  grid->addWidget(step_deg_, 0, 3);
  const std::array axes = {tr("x"), tr("y"), tr("z")};
  const std::array turns = {tr("roll"), tr("pitch"), tr("yaw")};
  for (std::size_t i = 0; i < 3; ++i) {
    position_mm_[i] = NumberBox(QString("part_position:") + kAxisKeys.at(i),
                                tr("Where the part's origin stands along %1, mm in world").arg(axes[i]),
                                kFarMm, tr(" mm"), this);
    rotation_deg_[i] =
        NumberBox(QString("part_rotation:") + kTurnKeys.at(i),
                  tr("%1: the turn about the world's fixed %2 axis, degrees").arg(turns[i], axes[i]),
                  kManyTurnsDeg, tr(" °"), this);
    const int row = static_cast<int>(i) + 1;
    grid->addWidget(new QLabel(axes[i]), row, 0);
    grid->addWidget(position_mm_[i], row, 1);
    grid->addWidget(new QLabel(turns[i]), row, 2);
    grid->addWidget(rotation_deg_[i], row, 3);
    connect(position_mm_[i], &QDoubleSpinBox::valueChanged, this,
            [this, i](double mm) { emit Moved(name_, static_cast<int>(i), mm); });
    connect(rotation_deg_[i], &QDoubleSpinBox::valueChanged, this,
            [this, i](double deg) { emit Turned(name_, static_cast<int>(i), deg); });
  }
  grid->setColumnStretch(1, 1);
  grid->setColumnStretch(3, 1);
  connect(step_mm_, &QComboBox::currentIndexChanged, this, &PartPanel::TakeSteps);
  connect(step_deg_, &QComboBox::currentIndexChanged, this, &PartPanel::TakeSteps);
  return rows;
}

QWidget* PartPanel::LookRow() {
  auto* row = new QWidget;
  auto* line = new QHBoxLayout(row);
  line->setContentsMargins(0, 0, 0, 0);
  color_ = new QToolButton;
  color_->setObjectName("part_color");
  color_->setAccessibleName(tr("Colour"));
  color_->setToolTip(tr("The part's colour in this view; the file has none"));
  connect(color_, &QToolButton::clicked, this, [this] {
    const QColor chosen = QColorDialog::getColor(look_.color.isValid() ? look_.color : usual_color_, this);
    if (!chosen.isValid()) return;
    look_.color = chosen;
    emit LookChanged(name_, look_);
  });
  opacity_ = new QSlider(Qt::Horizontal);
  opacity_->setObjectName("part_opacity");
  opacity_->setAccessibleName(tr("Opacity, percent"));
  opacity_->setToolTip(tr("How much of what is behind the part shows through; right: nothing"));
  opacity_->setRange(10, 100);
  opacity_->setValue(100);
  connect(opacity_, &QSlider::valueChanged, this, [this](int percent) {
    look_.opacity = 0.01 * percent;
    emit LookChanged(name_, look_);
  });
  auto* isolate = new QToolButton;
  isolate->setObjectName("part_isolate");
  isolate->setText(tr("Isolate"));
  isolate->setToolTip(tr("Hides all other parts; again: shows them all"));
  connect(isolate, &QToolButton::clicked, this, [this] { emit IsolateAsked(name_); });
  auto* remove = new QToolButton;
  remove->setObjectName("part_remove");
  remove->setText(tr("Remove"));
  remove->setToolTip(tr("Takes the part out of the layout, with the spacings and rules that name it"));
  connect(remove, &QToolButton::clicked, this, [this] { emit RemoveAsked(name_); });
  line->addWidget(color_);
  line->addWidget(opacity_, 1);
  line->addWidget(isolate);
  line->addWidget(remove);
  return row;
}

void PartPanel::TakeSteps() {
  for (QDoubleSpinBox* box : position_mm_) box->setSingleStep(step_mm_->currentData().toDouble());
  for (QDoubleSpinBox* box : rotation_deg_) box->setSingleStep(step_deg_->currentData().toDouble());
}

void PartPanel::Show(const core::Layout& layout, std::optional<core::PartIndex> part, const PartLook& look) {
  setEnabled(part.has_value());
  name_ = part ? QString::fromStdString(layout.parts[*part].name) : QString();
  look_ = look;
  if (!part) {
    what_->setText(tr("None. Click on one, in the view or in the list."));
    return;
  }
  const core::Part& shown = layout.parts[*part];
  const QString node = QString::fromStdString(shown.node);
  what_->setText(
      tr("%1: %2 mm")
          .arg(name_, QString::fromStdString(core::SizeText(core::BoundsOf(*shown.mesh).sizes()))));
  what_->setToolTip(QString::fromStdString(shown.file) + (node.isEmpty() ? QString() : "\n" + node));
  usual_color_ = PartColor(*part);
  color_->setIcon(Square(look.color.isValid() ? look.color : usual_color_));
  const QSignalBlocker blocker(opacity_);
  opacity_->setValue(static_cast<int>(100.0 * look.opacity + 0.5));
  ShowPlace(shown);
  ShowGaps(layout, *part);
}

void PartPanel::ShowPlace(const core::Part& part) {
  const Eigen::Vector3d rotation_deg = RollPitchYawDegOf(part);
  for (std::size_t i = 0; i < 3; ++i) {
    const QSignalBlocker position(position_mm_[i]), rotation(rotation_deg_[i]);
    position_mm_[i]->setValue(part.world_from_part.translation_mm[static_cast<Eigen::Index>(i)]);
    rotation_deg_[i]->setValue(rotation_deg[static_cast<Eigen::Index>(i)]);
  }
}

// Along the axis of a gap that moves the part, the gap decides where it stands.
void PartPanel::ShowGaps(const core::Layout& layout, core::PartIndex part) {
  for (QDoubleSpinBox* box : position_mm_) {
    box->setEnabled(true);
    box->setToolTip(box->accessibleName());
  }
  for (const core::Spacing& spacing : layout.spacings) {
    const std::vector<core::PartIndex> moving = layout.PartsNamed(spacing.moving);
    if (std::ranges::find(moving, part) == moving.end()) continue;
    QDoubleSpinBox* box = position_mm_.at(static_cast<std::size_t>(spacing.axis));
    box->setEnabled(false);
    box->setToolTip(tr("The spacing %1 decides it").arg(QString::fromStdString(spacing.name)));
  }
}

bool PartPanel::eventFilter(QObject* watched, QEvent* event) {
  if (event->type() == QEvent::ShortcutOverride || event->type() == QEvent::KeyPress) {
    auto* key = static_cast<QKeyEvent*>(event);
    const bool is_undo = key->matches(QKeySequence::Undo), is_redo = key->matches(QKeySequence::Redo);
    if (is_undo || is_redo) {
      event->accept();
      if (event->type() == QEvent::KeyPress) {
        if (is_undo) emit UndoAsked();
        if (is_redo) emit RedoAsked();
      }
      return true;
    }
  }
  return QGroupBox::eventFilter(watched, event);
}

}  // namespace elbowroom::console
