#include "app/console/spacing_panel.h"

#include <QGridLayout>
#include <QKeyEvent>
#include <QSignalBlocker>
#include <QToolButton>
#include <QVBoxLayout>
#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "app/console/desktop/theme.h"
#include "app/control/pairs/ruled_pairs.h"

namespace elbowroom::console {
namespace {

constexpr double kSliderStepsPerMm = 10.0;  // the tenth of a millimetre that the number shows
constexpr double kButtonStepMm = 10.0;
constexpr double kSameMm = 1e-6;  // closer values are the same gap

int SliderFrom(double value_mm) { return static_cast<int>(std::lround(value_mm * kSliderStepsPerMm)); }

}  // namespace

SpacingControl::SpacingControl(const core::Spacing& spacing, QWidget* parent)
    : QWidget(parent), name_(spacing.name), min_mm_(spacing.min_mm), max_mm_(spacing.max_mm) {
  AddRows(spacing);
  box_->setRange(spacing.min_mm, spacing.max_mm);
  slider_->setRange(SliderFrom(spacing.min_mm), SliderFrom(spacing.max_mm));
  ShowValue(spacing.initial_mm);
  connect(slider_, &QSlider::valueChanged, this, [this](int value) { Request(value / kSliderStepsPerMm); });
  connect(box_, &QDoubleSpinBox::valueChanged, this, &SpacingControl::Request);
}

void SpacingControl::AddRows(const core::Spacing& spacing) {
  const QString name = QString::fromStdString(spacing.name);
  auto* grid = new QGridLayout(this);
  grid->setContentsMargins(0, 0, 0, 0);
  title_ = new QLabel(name);
  title_->setToolTip(tr("from %1 to %2 along %3")
                         .arg(QString::fromStdString(spacing.reference),
                              QString::fromStdString(spacing.moving),
                              QString::fromUtf8(core::ToString(spacing.axis).data())));
  applied_ = new QLabel;
  applied_->setForegroundRole(QPalette::PlaceholderText);  // the quiet one
  slider_ = new QSlider(Qt::Horizontal);
  slider_->setObjectName("spacing_slider:" + name);
  slider_->setPageStep(SliderFrom(kButtonStepMm));
  slider_->setAccessibleName(tr("Gap %1").arg(name));
  slider_->setToolTip(tr("The gap in mm; it takes effect with the next frame"));
  box_ = new QDoubleSpinBox;
  box_->setObjectName("spacing_box:" + name);
  box_->setDecimals(1);
  box_->setSuffix(tr(" mm"));
  box_->setAccessibleName(tr("Gap %1 in mm").arg(name));
  box_->setToolTip(tr("The gap in mm, from %1 to %2").arg(min_mm_).arg(max_mm_));
  box_->setKeyboardTracking(false);  // a number that is half typed isn't asked for
  box_->installEventFilter(this);
  grid->addWidget(title_, 0, 0, 1, 3);
  grid->addWidget(applied_, 0, 3, Qt::AlignRight);
  int column = 0;
  for (const double by_mm : {-kButtonStepMm, kButtonStepMm}) {
    auto* button = new QToolButton;
    button->setText(by_mm < 0 ? "−" : "+");
    button->setObjectName((by_mm < 0 ? "spacing_minus:" : "spacing_plus:") + name);
    button->setAccessibleName(by_mm < 0 ? tr("Narrow %1").arg(name) : tr("Widen %1").arg(name));
    button->setToolTip(tr("%1 mm (keys − and +; with Shift 1 mm)").arg(by_mm, 0, 'f', 0));
    button->setAutoRepeat(true);
    connect(button, &QToolButton::clicked, this, [this, by_mm] { Step(by_mm); });
    grid->addWidget(button, 1, column);
    column += 2;
  }
  grid->addWidget(slider_, 1, 1);
  grid->addWidget(box_, 1, 3);
  grid->setColumnStretch(1, 1);
}

void SpacingControl::Step(double by_mm) { box_->setValue(box_->value() + by_mm); }

void SpacingControl::SetIsActive(bool is_active) {
  QFont font = title_->font();
  font.setBold(is_active);
  title_->setFont(font);
}

void SpacingControl::Request(double to_mm) {
  const double allowed_mm = std::clamp(to_mm, min_mm_, max_mm_);
  ShowValue(allowed_mm);
  awaited_mm_ = allowed_mm;
  emit Requested(name_, allowed_mm);
}

// The keys for undo and redo change the gaps, not the digits typed in the box.
bool SpacingControl::eventFilter(QObject* watched, QEvent* event) {
  if (event->type() == QEvent::ShortcutOverride) {
    const auto* key = static_cast<QKeyEvent*>(event);
    if (key->matches(QKeySequence::Undo) || key->matches(QKeySequence::Redo)) {
      event->ignore();
      return true;
    }
  }
  return QWidget::eventFilter(watched, event);
}

void SpacingControl::ShowValue(double value_mm) {
  value_mm_ = value_mm;
  const QSignalBlocker slider_is_quiet(slider_);
  const QSignalBlocker box_is_quiet(box_);
  slider_->setValue(SliderFrom(value_mm));
  box_->setValue(value_mm);
}

void SpacingControl::ShowApplied(double applied_mm) {
  applied_->setText(tr("in frame: %1 mm").arg(applied_mm, 0, 'f', 1));
  if (awaited_mm_ && std::abs(*awaited_mm_ - applied_mm) < kSameMm) awaited_mm_.reset();
  const bool is_changed = !applied_mm_ || std::abs(*applied_mm_ - applied_mm) >= kSameMm;
  applied_mm_ = applied_mm;
  if (is_changed && !awaited_mm_) ShowValue(applied_mm);
}

SpacingPanel::SpacingPanel(QWidget* parent) : QGroupBox(tr("Gaps"), parent) {
  auto* column = new QVBoxLayout(this);
  column->setSpacing(10);
  history_ = new GapHistory(this);
  hide();  // until there is a gap
  connect(history_, &GapHistory::Changed, this, &SpacingPanel::HistoryChanged);
}

void SpacingPanel::Open(const core::Layout& layout) {
  qDeleteAll(controls_);
  controls_.clear();
  qDeleteAll(rules_);
  rules_.clear();
  active_ = nullptr;
  history_->Open(layout.InitialSpacings());
  const std::vector<review::PairDemand> pairs = control::RuledPairsOf(layout);
  std::set<std::size_t> of_no_spacing;
  for (std::size_t i = 0; i < pairs.size(); ++i) of_no_spacing.insert(i);
  for (const core::Spacing& spacing : layout.spacings) {
    auto* control = new SpacingControl(spacing, this);
    const std::size_t index = controls_.size();
    controls_.push_back(control);
    this->layout()->addWidget(control);
    connect(control, &SpacingControl::Requested, this,
            [this, control, index](const std::string& name, double to_mm) {
              Activate(control);
              history_->Change(index, to_mm);
              emit Requested(name, to_mm);
            });
    std::vector<std::size_t> moved = control::PairsMovedBy(layout, index, pairs);
    for (const std::size_t pair : moved) of_no_spacing.erase(pair);
    AddRules(layout, std::move(moved), false);
  }
  AddRules(layout, {of_no_spacing.begin(), of_no_spacing.end()}, true);
  if (!controls_.empty()) Activate(controls_.front());
  setVisible(!controls_.empty() || !pairs.empty());
}

void SpacingPanel::AddRules(const core::Layout& layout, std::vector<std::size_t> shown, bool only_broken) {
  auto* list = new PairRuleList(layout, std::move(shown), only_broken, this);
  rules_.push_back(list);
  this->layout()->addWidget(list);
}

void SpacingPanel::ShowPairs(const control::FrameResult& result) {
  for (PairRuleList* list : rules_) list->ShowVerdicts(result.pairs, result.record.spacing_mm);
}

void SpacingPanel::Activate(SpacingControl* control) {
  active_ = control;
  for (SpacingControl* each : controls_) each->SetIsActive(each == active_ && controls_.size() > 1);
}

void SpacingPanel::ShowApplied(std::span<const double> spacing_mm) {
  for (std::size_t i = 0; i < spacing_mm.size() && i < controls_.size(); ++i) {
    controls_[i]->ShowApplied(spacing_mm[i]);
  }
}

void SpacingPanel::StepActive(double by_mm) {
  if (active_ != nullptr && isEnabled()) active_->Step(by_mm);
}

void SpacingPanel::changeEvent(QEvent* event) {
  QGroupBox::changeEvent(event);
  if (event->type() == QEvent::EnabledChange) emit HistoryChanged();
}

void SpacingPanel::Undo() {
  if (isEnabled() && history_->CanUndo()) Restore(history_->Undo());
}

void SpacingPanel::Redo() {
  if (isEnabled() && history_->CanRedo()) Restore(history_->Redo());
}

void SpacingPanel::Restore(const GapHistory::Gaps& gap_mm) {
  for (std::size_t i = 0; i < controls_.size(); ++i) {
    if (!controls_[i]->Is(gap_mm[i])) controls_[i]->Request(gap_mm[i]);
  }
}

}  // namespace elbowroom::console
