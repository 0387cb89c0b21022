#include "app/console/procedure/question_form.h"

#include <QHBoxLayout>
#include <QLabel>
#include <QToolButton>

#include "core/procedure/answers.h"

namespace elbowroom::console {
namespace {

constexpr double kLargestEstimateMm = 100'000.0;
constexpr int kEstimateRows = 1;  // of the form, before the items
constexpr int kMostButtons = 11;  // longer scales have a box of numbers

QString WordOf(core::AskedWhen when) {
  const std::string_view word = core::ToString(when);
  return QString::fromUtf8(word.data(), static_cast<qsizetype>(word.size()));
}

}  // namespace

QuestionForm::QuestionForm(core::AskedWhen when, QWidget* parent)
    : QWidget(parent), when_(when), form_(new QFormLayout(this)), estimate_(new QDoubleSpinBox) {
  form_->setContentsMargins(0, 0, 0, 0);
  form_->setRowWrapPolicy(QFormLayout::WrapAllRows);
  estimate_->setObjectName("estimate:" + WordOf(when));
  estimate_->setAccessibleName(tr("Estimate of the space needed, in mm"));
  estimate_->setToolTip(tr("How much space the participant thinks that the task needs, in mm; 0: not given"));
  estimate_->setRange(0.0, kLargestEstimateMm);
  estimate_->setDecimals(1);
  estimate_->setSuffix(tr(" mm"));
  estimate_->setSpecialValueText(tr("not given"));
  estimate_->setButtonSymbols(QAbstractSpinBox::NoButtons);
  form_->addRow(when == core::AskedWhen::kBefore ? tr("How much space will the task need?")
                                                 : tr("How much space did the task need?"),
                estimate_);
}

void QuestionForm::Open(const core::TrialInfo& trial, std::optional<double> estimate_mm) {
  while (form_->rowCount() > kEstimateRows) form_->removeRow(form_->rowCount() - 1);
  questions_.clear();
  estimate_->setValue(estimate_mm.value_or(0.0));
  for (const core::SurveyItem& item : trial.survey)
    if (item.when == when_) AddItem(item);
}

void QuestionForm::AddItem(const core::SurveyItem& item) {
  const QString name = QString("answer:%1:%2").arg(WordOf(when_)).arg(questions_.size());
  auto* label = new QLabel(QString::fromStdString(item.item));
  label->setTextFormat(Qt::PlainText);
  label->setWordWrap(true);
  const bool has_buttons = item.most - item.least < kMostButtons;
  form_->addRow(label);  // over the form's width
  form_->addRow(has_buttons ? ButtonsOf(item, name) : BoxOf(item, name));
}

QWidget* QuestionForm::ButtonsOf(const core::SurveyItem& item, const QString& name) {
  auto* row = new QWidget;
  auto* line = new QHBoxLayout(row);
  line->setContentsMargins(0, 0, 0, 0);
  line->setSpacing(2);
  auto* group = new QButtonGroup(row);
  for (int value = item.least; value <= item.most; ++value) {
    auto* button = new QToolButton;
    button->setObjectName(QString("%1:%2").arg(name).arg(value));
    button->setText(QString::number(value));
    button->setCheckable(true);
    button->setAccessibleName(QString("%1: %2").arg(QString::fromStdString(item.item)).arg(value));
    button->setToolTip(tr("%1, on a scale from %2 to %3").arg(value).arg(item.least).arg(item.most));
    group->addButton(button, value - item.least);
    line->addWidget(button);
  }
  line->addStretch(1);
  questions_.push_back({item, [group, least = item.least]() -> std::optional<int> {
                          if (group->checkedId() < 0) return std::nullopt;
                          return group->checkedId() + least;
                        }});
  return row;
}

QWidget* QuestionForm::BoxOf(const core::SurveyItem& item, const QString& name) {
  auto* box = new QSpinBox;
  box->setObjectName(name);
  box->setAccessibleName(QString::fromStdString(item.item));
  box->setRange(item.least - 1, item.most);  // one below the scale stands for no answer
  box->setValue(item.least - 1);
  box->setSpecialValueText(tr("not answered"));
  box->setToolTip(tr("On a scale from %1 to %2").arg(item.least).arg(item.most));
  questions_.push_back({item, [box, least = item.least]() -> std::optional<int> {
                          return box->value() < least ? std::nullopt : std::optional(box->value());
                        }});
  return box;
}

std::optional<double> QuestionForm::estimate_mm() const {
  return estimate_->value() > 0.0 ? std::optional(estimate_->value()) : std::nullopt;
}

std::vector<core::EventContent> QuestionForm::Said() const {
  std::vector<core::EventContent> said;
  if (const auto estimate = estimate_mm()) said.emplace_back(core::EstimateGiven{when_, *estimate});
  for (const Question& question : questions_)
    if (const std::optional<int> answer = question.answer())
      said.emplace_back(core::SurveyAnswered{when_, question.item.item, *answer});
  return said;
}

void QuestionForm::FocusEstimate() {
  estimate_->setFocus(Qt::OtherFocusReason);
  estimate_->selectAll();
}

}  // namespace elbowroom::console
