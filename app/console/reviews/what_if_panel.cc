#include "app/console/reviews/what_if_panel.h"

#include <QGridLayout>
#include <QHBoxLayout>
#include <QSignalBlocker>
#include <algorithm>
#include <cmath>
#include <utility>

#include "app/console/desktop/theme.h"
#include "app/console/reviews/what_if_text.h"
#include "app/console/view/verdict_word.h"

namespace elbowroom::console {
namespace {

constexpr double kSliderStepsPerMm = 10.0;  // the tenth of a millimetre that the number shows
constexpr double kPageMm = 10.0;

int SliderFrom(double value_mm) { return static_cast<int>(std::lround(value_mm * kSliderStepsPerMm)); }

QString PartText(const control::WhatIfPart& part, const QString& name) {
  QString text = WhatIfPanel::tr("%1: %2").arg(name, VerdictWord(part.verdict()));
  if (part.touches > 0)
    text +=
        WhatIfPanel::tr(" (%1×, ≥ %2 mm)").arg(part.touches).arg(std::floor(10.0 * part.deepest_mm) / 10.0);
  else if (part.clearance_mm && std::isfinite(*part.clearance_mm))
    text += WhatIfPanel::tr(" (≥ %1 mm)").arg(std::floor(10.0 * *part.clearance_mm) / 10.0);
  return text;
}

}  // namespace

WhatIfPanel::WhatIfPanel(QWidget* parent)
    : QGroupBox(tr("What if"), parent),
      column_(new QVBoxLayout(this)),
      result_(new QLabel),
      details_(new QLabel),
      progress_(new QProgressBar),
      let_go_(new QPushButton(tr("As &recorded"))) {
  column_->setContentsMargins(8, 4, 8, 6);
  column_->setSpacing(3);
  result_->setObjectName("what_if_result");
  result_->setWordWrap(true);
  result_->setTextFormat(Qt::PlainText);
  details_->setObjectName("what_if_details");
  details_->setWordWrap(true);
  details_->setTextFormat(Qt::PlainText);
  details_->setForegroundRole(QPalette::PlaceholderText);
  progress_->setObjectName("what_if_progress");
  progress_->setMaximumWidth(160);
  progress_->setTextVisible(false);
  progress_->hide();
  let_go_->setObjectName("what_if_off");
  let_go_->setToolTip(tr("Show the session with the gaps that it was recorded with"));
  connect(let_go_, &QPushButton::clicked, this, &WhatIfPanel::LetGo);
  auto* line = new QHBoxLayout;
  line->addWidget(result_, 1);
  line->addWidget(progress_);
  line->addWidget(let_go_);
  column_->addLayout(line);
  column_->addWidget(details_);
}

void WhatIfPanel::Open(const core::SessionHeader& header) {
  header_ = header;
  rows_.clear();
  needed_.clear();
  delete controls_;
  controls_ = new QWidget;
  auto* grid = new QGridLayout(controls_);
  grid->setContentsMargins(0, 0, 0, 0);
  grid->setColumnStretch(1, 1);
  for (const core::Spacing& spacing : header.layout.spacings) AddRow(spacing, controls_);
  column_->insertWidget(0, controls_);
  setVisible(!rows_.empty());
  ShowRecorded();
}

void WhatIfPanel::AddRow(const core::Spacing& spacing, QWidget* rows) {
  const QString name = QString::fromStdString(spacing.name);
  Row row{spacing.name, new QSlider(Qt::Horizontal), new QDoubleSpinBox, new QPushButton(tr("Needed?")),
          false};
  const QString tip =
      tr("Judge the whole recorded motion with this gap from %1 to %2, mm")
          .arg(QString::fromStdString(spacing.reference), QString::fromStdString(spacing.moving));
  row.slider->setObjectName("what_if_slider:" + name);
  row.slider->setAccessibleName(tr("What if %1, mm").arg(name));
  row.slider->setRange(SliderFrom(spacing.min_mm), SliderFrom(spacing.max_mm));
  row.slider->setPageStep(SliderFrom(kPageMm));
  row.slider->setSingleStep(SliderFrom(1.0));
  row.slider->setToolTip(tip);
  row.box->setObjectName("what_if_box:" + name);
  row.box->setAccessibleName(tr("What if %1").arg(name));
  row.box->setRange(spacing.min_mm, spacing.max_mm);
  row.box->setDecimals(1);
  row.box->setSuffix(tr(" mm"));
  row.box->setKeyboardTracking(false);
  row.box->setToolTip(tip);
  row.needed->setObjectName("what_if_needed:" + name);
  row.needed->setToolTip(
      tr("Find the smallest gap at which nothing is touched, within 0.5 mm, and the one at "
         "which the required clearance is sure"));
  const std::size_t place = rows_.size();
  connect(row.slider, &QSlider::valueChanged, this,
          [this, place](int value) { Hold(place, value / kSliderStepsPerMm); });
  connect(row.box, &QDoubleSpinBox::valueChanged, this, [this, place](double value) { Hold(place, value); });
  connect(row.needed, &QPushButton::clicked, this,
          [this, spacing_name = spacing.name] { emit NeededAsked(spacing_name); });
  auto* grid = static_cast<QGridLayout*>(rows->layout());
  const auto line = static_cast<int>(place);
  auto* title = new QLabel(name);
  title->setBuddy(row.box);
  grid->addWidget(title, line, 0);
  grid->addWidget(row.slider, line, 1);
  grid->addWidget(row.box, line, 2);
  grid->addWidget(row.needed, line, 3);
  rows_.push_back(row);
}

void WhatIfPanel::ShowValue(const Row& row, double value_mm) {
  const QSignalBlocker slider_is_quiet(row.slider);
  const QSignalBlocker box_is_quiet(row.box);
  row.slider->setValue(SliderFrom(value_mm));
  row.box->setValue(value_mm);
}

void WhatIfPanel::ShowGaps(const std::vector<double>& spacing_mm) {
  for (std::size_t i = 0; i < rows_.size() && i < spacing_mm.size(); ++i)
    if (!rows_[i].is_held) ShowValue(rows_[i], spacing_mm[i]);
}

void WhatIfPanel::Hold(std::size_t row, double value_mm) {
  rows_[row].is_held = true;
  ShowValue(rows_[row], value_mm);
  control::HeldGaps held_mm;
  for (const Row& each : rows_)
    if (each.is_held) held_mm[each.name] = each.box->value();
  let_go_->setEnabled(true);
  details_->setText(tr("Judging the whole motion …"));
  ShowProgress(0, 0);
  emit Held(held_mm);
}

void WhatIfPanel::LetGo() {
  for (Row& row : rows_) row.is_held = false;
  emit Held({});
}

void WhatIfPanel::ShowFrame(const control::FrameResult& result) {
  if (!progress_->isVisibleTo(this)) return;  // the whole motion is known
  QStringList parts;
  for (const core::PartContact& contact : result.record.contacts) {
    if (contact.verdict == core::Verdict::kClear) continue;
    parts << QString("%1 %2").arg(QString::fromStdString(header_.layout.parts[contact.part].name),
                                  VerdictWord(contact.verdict));
  }
  result_->setText(tr("This frame: %1").arg(parts.isEmpty() ? tr("all clear") : parts.join(", ")));
}

void WhatIfPanel::ShowProgress(qint64 done, qint64 total) {
  progress_->setMaximum(static_cast<int>(total));
  progress_->setValue(static_cast<int>(done));
  progress_->show();
}

void WhatIfPanel::ShowWhatIf(const control::WhatIf& what_if) {
  progress_->hide();
  result_->setText(WhatIfText(what_if, header_) + NeededOf(what_if.held_mm));
  QStringList parts;
  for (std::size_t i = 0; i < what_if.parts.size(); ++i)
    if (what_if.parts[i].is_moved)
      parts << PartText(what_if.parts[i], QString::fromStdString(header_.layout.parts[i].name));
  parts << SkippedText(what_if);
  details_->setText(parts.join("; "));
}

// A needed gap holds while the other spacings are as recorded.
QString WhatIfPanel::NeededOf(const control::HeldGaps& held_mm) const {
  if (held_mm.size() != 1) return {};
  const auto needed = needed_.find(held_mm.begin()->first);
  if (needed == needed_.end() || !needed->second.free_mm) return {};
  return tr("; needed %1 mm").arg(std::ceil(10.0 * *needed->second.free_mm) / 10.0, 0, 'f', 1);
}

void WhatIfPanel::ShowRecorded() {
  progress_->hide();
  for (Row& row : rows_) row.is_held = false;
  let_go_->setEnabled(false);
  result_->setText(tr("As recorded. Move a gap to judge the same motion with it."));
  details_->setText({});
}

void WhatIfPanel::ShowNeeded(const QString& spacing, const control::NeededGap& needed) {
  needed_[spacing.toStdString()] = needed;
  details_->setText(NeededText(spacing, needed, header_.trial.required_clearance_mm));
}

void WhatIfPanel::SetCanFind(bool can_find) {
  for (const Row& row : rows_) row.needed->setEnabled(can_find);
}

}  // namespace elbowroom::console
