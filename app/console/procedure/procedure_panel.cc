#include "app/console/procedure/procedure_panel.h"

#include <QHBoxLayout>
#include <QVBoxLayout>
#include <algorithm>

namespace elbowroom::console {
namespace {

constexpr int kLongestBookmark = 200;
constexpr double kTimeScale = 1.6;
constexpr int kListPx = 90;

// "1:05"
QString Clock(double time_s) {
  const auto seconds = static_cast<qint64>(std::max(time_s, 0.0));
  return QString("%1:%2").arg(seconds / 60).arg(seconds % 60, 2, 10, QChar('0'));
}

QLabel* LargeLabel(const QString& name) {
  auto* label = new QLabel;
  label->setObjectName(name);
  QFont font = label->font();
  font.setPointSizeF(kTimeScale * font.pointSizeF());
  label->setFont(font);
  return label;
}

}  // namespace

ProcedurePanel::ProcedurePanel(QWidget* parent) : QWidget(parent) {
  trial_time_ = LargeLabel("trial_time");
  trial_time_->setToolTip(tr("Minutes and seconds from the trial's first frame"));
  step_time_ = LargeLabel("step_time");
  step_time_->setToolTip(tr("Minutes and seconds since the step began"));
  auto* times = new QHBoxLayout;
  times->addWidget(trial_time_);
  times->addStretch(1);
  times->addWidget(step_time_);
  list_ = new QListWidget;
  list_->setObjectName("step_list");
  list_->setAccessibleName(tr("Steps of the procedure"));
  list_->setToolTip(tr("Double-click a step to begin it, again or out of turn"));
  list_->setFocusPolicy(Qt::TabFocus);  // a click leaves the keys to the trial
  list_->setWordWrap(true);
  list_->setMinimumHeight(kListPx);
  list_->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  next_ = new QPushButton;
  next_->setObjectName("next_step");
  sound_ = new QCheckBox;
  sound_->setObjectName("contact_sound");
  ShowSound(QString());
  auto* column = new QVBoxLayout(this);
  column->addLayout(times);
  column->addWidget(list_, 1);
  column->addWidget(next_);
  column->addWidget(MakeBookmarks());
  column->addWidget(sound_);
  connect(list_, &QListWidget::itemActivated, this,
          [this](const QListWidgetItem* item) { Ask(static_cast<std::size_t>(list_->row(item))); });
  connect(next_, &QPushButton::clicked, this, &ProcedurePanel::Next);
  Open({}, false);
}

QWidget* ProcedurePanel::MakeBookmarks() {
  bookmark_ = new QPushButton(tr("Bookmark (M)"));
  bookmark_->setObjectName("bookmark");
  bookmark_->setToolTip(tr("Mark this moment of the trial, to find it again in the review and the report"));
  bookmark_name_ = new QLineEdit;
  bookmark_name_->setObjectName("bookmark_name");
  bookmark_name_->setAccessibleName(tr("Name of a bookmark"));
  bookmark_name_->setPlaceholderText(tr("Name, then Enter"));
  bookmark_name_->setToolTip(tr("A bookmark with a name, set when Enter is pressed"));
  bookmark_name_->setMaxLength(kLongestBookmark);
  auto* row = new QWidget;
  auto* line = new QHBoxLayout(row);
  line->setContentsMargins(0, 0, 0, 0);
  line->addWidget(bookmark_);
  line->addWidget(bookmark_name_, 1);
  connect(bookmark_, &QPushButton::clicked, this, &ProcedurePanel::SetBookmark);
  connect(bookmark_name_, &QLineEdit::returnPressed, this, &ProcedurePanel::SetBookmark);
  return row;
}

void ProcedurePanel::Open(const std::vector<std::string>& steps, bool begins_first) {
  steps_ = steps;
  was_begun_.assign(steps.size(), false);
  place_.reset();
  list_->clear();
  for (std::size_t i = 0; i < steps.size(); ++i) list_->addItem(QString());
  if (begins_first && !steps.empty()) was_begun_[*(place_ = 0)] = true;
  bookmark_name_->clear();
  trial_time_->setText(tr("Trial %1").arg(Clock(0.0)));
  step_time_->clear();
  list_->setVisible(!steps.empty());
  next_->setVisible(!steps.empty());
  ShowPlace();
}

void ProcedurePanel::ShowTime(double time_s, const std::optional<core::StepRun>& step) {
  trial_time_->setText(tr("Trial %1").arg(Clock(time_s)));
  step_time_->setText(step ? tr("Step %1").arg(Clock(time_s - step->begin_s)) : QString());
}

void ProcedurePanel::ShowEnd() {
  place_.reset();
  step_time_->clear();
  ShowPlace();
}

void ProcedurePanel::ShowSound(const QString& trouble) {
  sound_->setText(trouble.isEmpty() ? tr("&Sound on contact") : tr("&Sound on contact (not heard)"));
  sound_->setToolTip(trouble.isEmpty()
                         ? tr("The desktop's bell whenever a part is touched that wasn't; it sounds once now")
                         : tr("The sound can't be played: %1. Look whether the desktop's sound server runs, "
                              "then tick this again.")
                               .arg(trouble));
}

void ProcedurePanel::Next() {
  if (!isEnabled() || steps_.empty()) return;
  const std::size_t next = place_ ? *place_ + 1 : 0;
  Ask(next > steps_.size() ? 0 : next);
}

void ProcedurePanel::SetBookmark() {
  if (!isEnabled()) return;
  const QString name = bookmark_name_->text().trimmed();
  bookmark_name_->clear();
  if (bookmark_name_->hasFocus()) setFocus();  // the keys are the trial's again
  emit BookmarkAsked(name.toStdString());
}

void ProcedurePanel::Ask(std::size_t place) {
  if (!isEnabled()) return;
  place_ = place;
  if (place < steps_.size()) was_begun_[place] = true;
  ShowPlace();
  emit StepAsked(place < steps_.size() ? steps_[place] : std::string());
}

void ProcedurePanel::ShowPlace() {
  for (std::size_t i = 0; i < steps_.size(); ++i) {
    const bool is_now = place_ == i;
    const QString sign = is_now ? QString::fromUtf8("▶") : was_begun_[i] ? QString::fromUtf8("✓") : " ";
    QListWidgetItem* item = list_->item(static_cast<int>(i));
    item->setText(QString("%1 %2. %3").arg(sign).arg(i + 1).arg(QString::fromStdString(steps_[i])));
    QFont font = list_->font();
    font.setBold(is_now);
    item->setFont(font);
    if (is_now) list_->scrollToItem(item);
  }
  const bool is_last = place_ && *place_ + 1 == steps_.size();
  const bool is_first = !place_ || *place_ >= steps_.size();
  next_->setText(is_last    ? tr("End of the last step (N)")
                 : is_first ? tr("First step (N)")
                            : tr("Next step (N)"));
  next_->setToolTip(
      is_last ? tr("End the step under way; no other begins")
              : tr("End the step under way and begin the next one, with the frame that comes next"));
}

}  // namespace elbowroom::console
