#include "app/console/layouts/rule_dialogs.h"

#include <QFormLayout>
#include <QPushButton>
#include <QVBoxLayout>
#include <array>
#include <utility>

#include "app/console/desktop/theme.h"

namespace elbowroom::console {
namespace {

constexpr double kFarthestMm = 1e6;

QDoubleSpinBox* LengthBox(const QString& name, const QString& tool_tip, double value_mm, double least_mm) {
  auto* box = new QDoubleSpinBox;
  box->setObjectName(name);
  box->setToolTip(tool_tip);
  box->setDecimals(3);
  box->setRange(least_mm, kFarthestMm);
  box->setSuffix(QObject::tr(" mm"));
  box->setValue(value_mm);
  return box;
}

QComboBox* NameBox(const core::Layout& layout, const QString& name, const QString& tool_tip,
                   const std::string& chosen) {
  auto* box = new QComboBox;
  box->setObjectName(name);
  box->setToolTip(tool_tip);
  for (const core::Part& part : layout.parts) box->addItem(QString::fromStdString(part.name));
  for (const core::Group& group : layout.groups) box->addItem(QString::fromStdString(group.name));
  box->setCurrentText(QString::fromStdString(chosen));
  return box;
}

}  // namespace

RuleDialog::RuleDialog(const QString& title, QWidget* parent) : QDialog(parent) { setWindowTitle(title); }

void RuleDialog::Finish(QLayout* form) {
  fault_ = new QLabel;
  fault_->setObjectName("rule_fault");
  fault_->setWordWrap(true);
  fault_->setTextFormat(Qt::PlainText);
  QPalette palette = fault_->palette();
  palette.setColor(QPalette::WindowText, ThemeColors().contact);
  fault_->setPalette(palette);
  fault_->hide();
  auto* buttons = new QDialogButtonBox(QDialogButtonBox::Ok | QDialogButtonBox::Cancel);
  buttons->button(QDialogButtonBox::Ok)->setObjectName("rule_ok");
  connect(buttons, &QDialogButtonBox::rejected, this, &QDialog::reject);
  connect(buttons, &QDialogButtonBox::accepted, this, [this] {
    const QString fault = Put();
    if (fault.isEmpty()) return accept();
    fault_->setText(fault);
    fault_->show();
  });
  auto* column = new QVBoxLayout(this);
  column->addLayout(form);
  column->addWidget(fault_);
  column->addWidget(buttons);
  setMinimumWidth(380);
}

SpacingDialog::SpacingDialog(const core::Layout& layout, const core::Spacing& spacing, bool is_new,
                             PutRule<core::Spacing> put, QWidget* parent)
    : RuleDialog(is_new ? tr("New spacing") : tr("Spacing"), parent), put_(std::move(put)) {
  setObjectName("spacing_dialog");
  name_ = new QLineEdit(QString::fromStdString(spacing.name));
  name_->setObjectName("spacing_name");
  name_->setReadOnly(!is_new);
  name_->setToolTip(tr("What trials and reports call the gap"));
  reference_ = NameBox(layout, "spacing_reference", tr("The part or group that stays"), spacing.reference);
  moving_ = NameBox(layout, "spacing_moving", tr("The part or group that the gap moves"), spacing.moving);
  axis_ = new QComboBox;
  axis_->setObjectName("spacing_axis");
  axis_->setToolTip(
      tr("The direction of the world from the upper end of what stays to the lower end of what moves"));
  axis_->addItems({"x", "y", "z"});
  axis_->setCurrentIndex(static_cast<int>(spacing.axis));
  min_mm_ = LengthBox("spacing_min", tr("The smallest gap, mm; below 0 they overlap"), spacing.min_mm,
                      -kFarthestMm);
  max_mm_ = LengthBox("spacing_max", tr("The largest gap, mm"), spacing.max_mm, -kFarthestMm);
  initial_mm_ = LengthBox("spacing_initial", tr("The gap to start with, mm; as it is now"),
                          spacing.initial_mm, -kFarthestMm);
  auto* form = new QFormLayout;
  form->addRow(tr("&Name"), name_);
  form->addRow(tr("&From the upper end of"), reference_);
  form->addRow(tr("&To the lower end of"), moving_);
  form->addRow(tr("&Along"), axis_);
  form->addRow(tr("&Smallest gap"), min_mm_);
  form->addRow(tr("&Largest gap"), max_mm_);
  form->addRow(tr("&Gap to start with"), initial_mm_);
  Finish(form);
}

QString SpacingDialog::Put() {
  core::Spacing spacing;
  spacing.name = name_->text().toStdString();
  spacing.moving = moving_->currentText().toStdString();
  spacing.reference = reference_->currentText().toStdString();
  spacing.axis = static_cast<core::Axis>(axis_->currentIndex());
  spacing.min_mm = min_mm_->value();
  spacing.max_mm = max_mm_->value();
  spacing.initial_mm = initial_mm_->value();
  return put_(spacing);
}

PairDialog::PairDialog(const core::PairRule& rule, PutRule<core::PairRule> put, QWidget* parent)
    : RuleDialog(tr("Pair rule"), parent), put_(std::move(put)), rule_(rule) {
  setObjectName("pair_dialog");
  clearance_mm_ = LengthBox("pair_clearance", tr("How far apart their surfaces must be at least, mm"),
                            rule.required_clearance_mm, 0.0);
  may_touch_ = new QCheckBox(tr("They &may touch"));
  may_touch_->setObjectName("pair_may_touch");
  may_touch_->setToolTip(tr("Contact between them breaks no rule"));
  may_touch_->setChecked(rule.authorised_contact);
  ignore_ = new QCheckBox(tr("Don't &judge them"));
  ignore_->setObjectName("pair_ignore");
  ignore_->setToolTip(tr("Nothing is asked about this pair"));
  ignore_->setChecked(rule.ignore);
  auto* names =
      new QLabel(tr("%1 and %2").arg(QString::fromStdString(rule.a), QString::fromStdString(rule.b)));
  names->setTextFormat(Qt::PlainText);
  auto* form = new QFormLayout;
  form->addRow(tr("Between"), names);
  form->addRow(tr("&Required clearance"), clearance_mm_);
  form->addRow({}, may_touch_);
  form->addRow({}, ignore_);
  Finish(form);
}

QString PairDialog::Put() {
  rule_.required_clearance_mm = clearance_mm_->value();
  rule_.authorised_contact = may_touch_->isChecked();
  rule_.ignore = ignore_->isChecked();
  return put_(rule_);
}

}  // namespace elbowroom::console
