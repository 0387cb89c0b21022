#include "app/console/layouts/rule_panel.h"

#include <QHBoxLayout>
#include <QVBoxLayout>

namespace elbowroom::console {
namespace {

constexpr int kLeastRulesPx = 36;
constexpr int kIsPairRole = Qt::UserRole;
constexpr int kIndexRole = Qt::UserRole + 1;

QString SpacingLine(const core::Spacing& spacing) {
  return RulePanel::tr("%1: %2 mm along %3, from %4 to %5; may be %6 to %7")
      .arg(QString::fromStdString(spacing.name))
      .arg(spacing.initial_mm)
      .arg(QString::fromUtf8(core::ToString(spacing.axis).data()), QString::fromStdString(spacing.reference),
           QString::fromStdString(spacing.moving))
      .arg(spacing.min_mm)
      .arg(spacing.max_mm);
}

QString PairLine(const core::PairRule& rule) {
  const QString names =
      RulePanel::tr("%1 and %2").arg(QString::fromStdString(rule.a), QString::fromStdString(rule.b));
  if (rule.ignore) return RulePanel::tr("%1: not judged").arg(names);
  const QString clearance = RulePanel::tr("%1 mm apart at least").arg(rule.required_clearance_mm);
  return rule.authorised_contact ? RulePanel::tr("%1: may touch; else %2").arg(names, clearance)
                                 : RulePanel::tr("%1: %2").arg(names, clearance);
}

void AddRule(QListWidget* list, const QString& text, bool is_pair, std::size_t index) {
  auto* item = new QListWidgetItem(text, list);
  item->setData(kIsPairRole, is_pair);
  item->setData(kIndexRole, static_cast<qulonglong>(index));
  item->setToolTip(text);
}

QToolButton* SmallButton(const QString& name, const QString& text, const QString& tool_tip) {
  auto* button = new QToolButton;
  button->setObjectName(name);
  button->setText(text);
  button->setToolTip(tool_tip);
  return button;
}

}  // namespace

RulePanel::RulePanel(QWidget* parent) : QGroupBox(tr("Spacings and pair rules"), parent) {
  add_spacing_ = new QPushButton(tr("Sp&acing …"));
  add_spacing_->setObjectName("add_spacing");
  add_pair_ = new QPushButton(tr("Pair r&ule …"));
  add_pair_->setObjectName("add_pair");
  rules_ = new QListWidget;
  rules_->setObjectName("rules");
  rules_->setAccessibleName(tr("Spacings and pair rules"));
  rules_->setWordWrap(true);
  rules_->setMinimumHeight(kLeastRulesPx);
  rules_->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  change_ = SmallButton("change_rule", tr("Change …"), tr("Changes the line that is chosen"));
  remove_ = SmallButton("remove_rule", tr("Remove"), tr("Removes the line that is chosen"));
  connect(add_spacing_, &QPushButton::clicked, this, &RulePanel::SpacingAsked);
  connect(add_pair_, &QPushButton::clicked, this, &RulePanel::PairAsked);
  connect(change_, &QToolButton::clicked, this, &RulePanel::Change);
  connect(remove_, &QToolButton::clicked, this, &RulePanel::Remove);
  connect(rules_, &QListWidget::itemActivated, this, &RulePanel::Change);
  connect(rules_, &QListWidget::itemSelectionChanged, this, &RulePanel::ShowButtons);
  auto* two = new QHBoxLayout;
  two->addWidget(add_spacing_);
  two->addWidget(add_pair_);
  auto* below = new QHBoxLayout;
  below->addStretch(1);
  below->addWidget(change_);
  below->addWidget(remove_);
  auto* column = new QVBoxLayout(this);
  column->setSpacing(4);
  column->addLayout(two);
  column->addWidget(rules_, 1);
  column->addLayout(below);
}

void RulePanel::Show(const core::Layout& layout, const QStringList& chosen) {
  const int row = rules_->currentRow();
  rules_->clear();
  for (std::size_t i = 0; i < layout.spacings.size(); ++i)
    AddRule(rules_, SpacingLine(layout.spacings[i]), false, i);
  for (std::size_t i = 0; i < layout.pair_rules.size(); ++i)
    AddRule(rules_, PairLine(layout.pair_rules[i]), true, i);
  if (row >= 0 && row < rules_->count()) rules_->setCurrentRow(row);
  const bool are_two = chosen.size() == 2;
  for (QPushButton* button : {add_spacing_, add_pair_}) button->setEnabled(are_two);
  const QString what = are_two ? tr("between %1 and %2").arg(chosen[0], chosen[1])
                               : tr("choose two parts first: click on one, then Ctrl+click on the other");
  add_spacing_->setToolTip(tr("A gap that trials may change, %1").arg(what));
  add_pair_->setToolTip(tr("How far apart they must stay, in mm, %1").arg(what));
  ShowButtons();
}

void RulePanel::ShowButtons() {
  for (QToolButton* button : {change_, remove_}) button->setEnabled(rules_->currentItem() != nullptr);
}

void RulePanel::Change() {
  const QListWidgetItem* item = rules_->currentItem();
  if (item == nullptr) return;
  const std::size_t index = item->data(kIndexRole).toULongLong();
  if (item->data(kIsPairRole).toBool()) {
    emit PairChangeAsked(index);
  } else {
    emit SpacingChangeAsked(index);
  }
}

void RulePanel::Remove() {
  const QListWidgetItem* item = rules_->currentItem();
  if (item == nullptr) return;
  const std::size_t index = item->data(kIndexRole).toULongLong();
  if (item->data(kIsPairRole).toBool()) {
    emit PairRemovalAsked(index);
  } else {
    emit SpacingRemovalAsked(index);
  }
}

}  // namespace elbowroom::console
