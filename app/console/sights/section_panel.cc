#include "app/console/sights/section_panel.h"

#include <QGridLayout>
#include <QSettings>
#include <QSignalBlocker>
#include <cmath>

namespace elbowroom::console {
namespace {

constexpr std::array kAxes = {"x", "y", "z"};
constexpr double kSliderStepMm = 1.0;

QString Key(std::size_t axis, const char* what) { return QString("section/%1_%2").arg(kAxes.at(axis), what); }

}  // namespace

SectionPanel::SectionPanel(QWidget* parent) : QWidget(parent) {
  setObjectName("section_panel");
  auto* grid = new QGridLayout(this);
  grid->setContentsMargins(0, 0, 0, 0);
  grid->setVerticalSpacing(2);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    rows_[axis] = MakeRow(axis);
    const int line = static_cast<int>(axis);
    grid->addWidget(rows_[axis].is_on, line, 0);
    grid->addWidget(rows_[axis].slider, line, 1);
    grid->addWidget(rows_[axis].at_mm, line, 2);
    grid->addWidget(rows_[axis].flip, line, 3);
  }
  grid->setColumnStretch(1, 1);
  hide();
}

SectionPanel::Row SectionPanel::MakeRow(std::size_t axis) {
  const QSettings settings;
  const QString name = QString(kAxes.at(axis)).toUpper();
  Row row{new QCheckBox(tr("Cut across %1").arg(name)), new QSlider(Qt::Horizontal), new QDoubleSpinBox,
          new QToolButton};
  row.is_on->setObjectName(QString("section_on:") + kAxes.at(axis));
  row.is_on->setToolTip(tr("Cut parts and hull open at a place of the world's %1 axis").arg(name));
  row.is_on->setChecked(settings.value(Key(axis, "on"), false).toBool());
  row.slider->setObjectName(QString("section_slider:") + kAxes.at(axis));
  row.slider->setAccessibleName(tr("Place of the cut across %1, mm").arg(name));
  row.slider->setToolTip(tr("Place of the cut, mm; in the 3-D view: drag with Shift"));
  row.at_mm->setObjectName(QString("section_mm:") + kAxes.at(axis));
  row.at_mm->setAccessibleName(row.slider->accessibleName());
  row.at_mm->setToolTip(row.slider->toolTip());
  row.at_mm->setDecimals(1);
  row.at_mm->setSuffix(tr(" mm"));
  row.at_mm->setRange(-1e5, 1e5);
  row.at_mm->setValue(settings.value(Key(axis, "mm"), 0.0).toDouble());
  row.flip->setObjectName(QString("section_flip:") + kAxes.at(axis));
  row.flip->setText(tr("Flip"));
  row.flip->setAccessibleName(tr("Keep the other side of the cut across %1").arg(name));
  row.flip->setToolTip(tr("Keep the other side of the cut"));
  row.flip->setCheckable(true);
  // The eye is in front at first, so that what is behind stays.
  row.flip->setChecked(settings.value(Key(axis, "above"), axis == 1).toBool());
  const auto used = [this, axis] {
    last_used_ = axis;
    Tell();
  };
  connect(row.is_on, &QCheckBox::toggled, this, used);
  connect(row.flip, &QToolButton::toggled, this, used);
  connect(row.at_mm, &QDoubleSpinBox::valueChanged, this, [this, axis, used](double at_mm) {
    const QSignalBlocker quiet(rows_[axis].slider);
    rows_[axis].slider->setValue(static_cast<int>(std::lround(at_mm / kSliderStepMm)));
    used();
  });
  connect(row.slider, &QSlider::valueChanged, this, [this, axis](int step) {
    rows_[axis].is_on->setChecked(true);
    rows_[axis].at_mm->setValue(kSliderStepMm * step);
  });
  return row;
}

void SectionPanel::Open(const Eigen::AlignedBox3d& workspace_mm) {
  std::array<bool, 3> is_remembered{};  // before the first value is
  for (std::size_t axis = 0; axis < 3; ++axis) is_remembered[axis] = QSettings().contains(Key(axis, "mm"));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<Eigen::Index>(axis);
    const QSignalBlocker quiet(rows_[axis].slider);
    if (!is_remembered[axis]) rows_[axis].at_mm->setValue(workspace_mm.center()[i]);
    rows_[axis].slider->setRange(static_cast<int>(std::floor(workspace_mm.min()[i])),
                                 static_cast<int>(std::ceil(workspace_mm.max()[i])));
    rows_[axis].slider->setValue(static_cast<int>(std::lround(rows_[axis].at_mm->value())));
  }
}

control::SectionCut SectionPanel::cut() const {
  control::SectionCut cut;
  if (isHidden()) return cut;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (rows_[axis].is_on->isChecked())
      cut.planes[axis] = control::CutPlane{rows_[axis].at_mm->value(), rows_[axis].flip->isChecked()};
  }
  return cut;
}

void SectionPanel::Drag(const Eigen::Vector3d& by_in_world_mm) {
  if (isHidden() || !rows_[last_used_].is_on->isChecked()) return;
  QDoubleSpinBox* at_mm = rows_[last_used_].at_mm;
  at_mm->setValue(at_mm->value() + by_in_world_mm[static_cast<Eigen::Index>(last_used_)]);
}

void SectionPanel::Tell() {
  Remember();
  emit Changed(cut());
}

void SectionPanel::Remember() const {
  QSettings settings;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    settings.setValue(Key(axis, "on"), rows_[axis].is_on->isChecked());
    settings.setValue(Key(axis, "mm"), rows_[axis].at_mm->value());
    settings.setValue(Key(axis, "above"), rows_[axis].flip->isChecked());
  }
}

void SectionPanel::showEvent(QShowEvent* event) {
  QWidget::showEvent(event);
  emit Changed(cut());
}

void SectionPanel::hideEvent(QHideEvent* event) {
  QWidget::hideEvent(event);
  if (isHidden()) emit Changed(cut());
}

}  // namespace elbowroom::console
