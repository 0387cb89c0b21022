#include "app/console/procedure/preset_panel.h"

#include <QHBoxLayout>
#include <QLabel>
#include <QShortcut>
#include <QVBoxLayout>
#include <algorithm>

namespace elbowroom::console {
namespace {

constexpr int kMostKeys = 9;
constexpr int kLongestPreset = 60;
// A slider on its way is one change.
constexpr double kSameChange_s = 1.0;
constexpr std::size_t kMostChanges = 500;

QString GapText(double gap_mm) { return QString::number(gap_mm, 'f', 1); }

QListWidget* MakeList(const QString& name, const QString& title, const QString& tool_tip) {
  auto* list = new QListWidget;
  list->setObjectName(name);
  list->setAccessibleName(title);
  list->setToolTip(tool_tip);
  list->setFocusPolicy(Qt::TabFocus);  // a click leaves the keys to the trial
  list->setWordWrap(true);
  list->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  return list;
}

}  // namespace

PresetPanel::PresetPanel(QWidget* window) {
  AddLists();
  for (int key = 0; key < kMostKeys; ++key) {
    auto* shortcut = new QShortcut(QKeySequence(Qt::CTRL | (Qt::Key_F1 + key)), window);
    connect(shortcut, &QShortcut::activated, this, [this, key] { Apply(static_cast<std::size_t>(key)); });
  }
}

void PresetPanel::AddLists() {
  list_ =
      MakeList("preset_list", tr("Gap presets"), tr("Double-click to set these gaps (Ctrl and F1 to F9)"));
  history_ =
      MakeList("gap_history", tr("History of gaps"), tr("Double-click to go back to the gaps of that time"));
  name_ = new QLineEdit;
  name_->setObjectName("preset_name");
  name_->setAccessibleName(tr("Name of a preset"));
  name_->setPlaceholderText(tr("Name of these gaps"));
  name_->setToolTip(tr("Under which the present gaps are kept, for all trials with these spacings"));
  name_->setMaxLength(kLongestPreset);
  save_ = new QPushButton(tr("Save"));
  save_->setObjectName("save_preset");
  save_->setToolTip(tr("Keep the present gaps under this name"));
  remove_ = new QPushButton(tr("Remove"));
  remove_->setObjectName("remove_preset");
  remove_->setToolTip(tr("Forget the preset that is selected"));
  auto* line = new QHBoxLayout;
  line->addWidget(save_);
  line->addWidget(remove_);
  auto* column = new QVBoxLayout(this);
  column->addWidget(list_, 1);
  column->addWidget(name_);
  column->addLayout(line);
  column->addWidget(new QLabel(tr("History")));
  column->addWidget(history_, 1);
  connect(list_, &QListWidget::itemActivated, this,
          [this](const QListWidgetItem* item) { Apply(static_cast<std::size_t>(list_->row(item))); });
  connect(history_, &QListWidget::itemActivated, this, [this](const QListWidgetItem* item) {
    if (isEnabled()) emit GapsAsked(changes_.at(static_cast<std::size_t>(history_->row(item))).gap_mm);
  });
  connect(save_, &QPushButton::clicked, this, &PresetPanel::Save);
  connect(name_, &QLineEdit::returnPressed, this, &PresetPanel::Save);
  connect(remove_, &QPushButton::clicked, this, &PresetPanel::Remove);
}

void PresetPanel::Open(const core::Layout& layout) {
  spacings_.clear();
  for (const core::Spacing& spacing : layout.spacings) spacings_.push_back(spacing.name);
  presets_ = PresetsFor(spacings_);
  gap_mm_ = layout.InitialSpacings();
  changes_.clear();
  history_->clear();
  ShowPresets();
}

void PresetPanel::ShowGaps(double time_s, const std::vector<double>& gap_mm) {
  if (gap_mm.size() != gap_mm_.size()) return;  // of the trial before
  const std::vector<double> before_mm = std::exchange(gap_mm_, gap_mm);
  for (std::size_t i = 0; i < gap_mm.size(); ++i)
    if (gap_mm[i] != before_mm[i]) AddRow(time_s, i, before_mm[i], gap_mm[i]);
}

void PresetPanel::AddRow(double time_s, std::size_t spacing, double from_mm, double to_mm) {
  const bool goes_on = !changes_.empty() && changes_.back().spacing == spacing &&
                       time_s - changes_.back().time_s < kSameChange_s;
  if (!goes_on) {
    if (changes_.size() == kMostChanges) {
      changes_.erase(changes_.begin());
      delete history_->takeItem(0);
    }
    changes_.push_back({time_s, spacing, from_mm, {}});
    history_->addItem(QString());
  }
  changes_.back().time_s = time_s;
  changes_.back().gap_mm = gap_mm_;
  history_->item(history_->count() - 1)
      ->setText(tr("%1 s  %2: %3 to %4 mm")
                    .arg(time_s, 0, 'f', 1)
                    .arg(QString::fromStdString(spacings_[spacing]), GapText(changes_.back().from_mm),
                         GapText(to_mm)));
  history_->scrollToBottom();
}

void PresetPanel::Apply(std::size_t place) {
  if (isEnabled() && place < presets_.size()) emit GapsAsked(presets_[place].gap_mm);
}

void PresetPanel::Save() {
  const QString name = name_->text().trimmed();
  if (name.isEmpty() || gap_mm_.empty()) return name_->setFocus();
  const auto same = std::ranges::find(presets_, name, &GapPreset::name);
  if (same == presets_.end()) {
    presets_.push_back({name, gap_mm_});
  } else {
    same->gap_mm = gap_mm_;
  }
  name_->clear();
  if (name_->hasFocus()) setFocus();  // the keys are the trial's again
  KeepPresets(spacings_, presets_);
  ShowPresets();
}

void PresetPanel::Remove() {
  const int row = list_->currentRow();
  if (row < 0) return;
  presets_.erase(presets_.begin() + row);
  KeepPresets(spacings_, presets_);
  ShowPresets();
}

void PresetPanel::ShowPresets() {
  list_->clear();
  for (std::size_t i = 0; i < presets_.size(); ++i) {
    QStringList gaps;
    for (const double gap_mm : presets_[i].gap_mm) gaps << GapText(gap_mm);
    list_->addItem(tr("%1. %2: %3 mm").arg(i + 1).arg(presets_[i].name, gaps.join(", ")));
  }
}

}  // namespace elbowroom::console
