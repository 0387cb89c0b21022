#include "app/console/procedure/question_form.h"

#include <utility>

#include "app/console/procedure/answer_field.h"
#include "core/procedure/answers.h"

namespace elbowroom::console {
namespace {

constexpr double kLargestEstimateMm = 100'000.0;
constexpr int kEstimateRows = 1;  // of the form, before the items

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
    if (item.when == when_) AddSurveyItem(item);
  for (const core::Questionnaire& questionnaire : trial.questionnaires)
    if (questionnaire.when == when_) AddQuestionnaire(questionnaire);
}

void QuestionForm::AddSurveyItem(const core::SurveyItem& item) {
  core::QuestionnaireItem asked{"", item.item};
  asked.least = item.least;
  asked.most = item.most;
  AddItem(asked, QString("answer:%1:%2").arg(WordOf(when_)).arg(questions_.size()),
          [item](const core::ItemAnswer& answer) {
            return core::SurveyAnswered{item.when, item.item, static_cast<int>(std::get<double>(answer))};
          });
}

void QuestionForm::AddQuestionnaire(const core::Questionnaire& questionnaire) {
  QLabel* title = AddLabel(questionnaire.name);
  QFont font = title->font();
  font.setBold(true);
  title->setFont(font);
  for (const core::QuestionnaireItem& item : questionnaire.items)
    AddItem(
        item,
        QString("questionnaire:%1:%2:%3")
            .arg(WordOf(when_), QString::fromStdString(questionnaire.name), QString::fromStdString(item.id)),
        [when = when_, name = questionnaire.name, id = item.id](const core::ItemAnswer& answer) {
          return core::QuestionnaireAnswered{when, name, id, answer};
        });
}

void QuestionForm::AddItem(const core::QuestionnaireItem& item, const QString& name,
                           std::function<core::EventContent(const core::ItemAnswer&)> event) {
  AddLabel(item.text);
  AnswerField field = MakeAnswerField(item, name);
  form_->addRow(field.widget);
  if (!item.least_anchor.empty() || !item.most_anchor.empty())
    AddLabel(tr("%1: %2; %3: %4")
                 .arg(item.least)
                 .arg(QString::fromStdString(item.least_anchor))
                 .arg(item.most)
                 .arg(QString::fromStdString(item.most_anchor))
                 .toStdString());
  questions_.push_back({std::move(field.answer), std::move(event)});
}

// Over the form's width.
QLabel* QuestionForm::AddLabel(const std::string& text) {
  auto* label = new QLabel(QString::fromStdString(text));
  label->setTextFormat(Qt::PlainText);
  label->setWordWrap(true);
  form_->addRow(label);
  return label;
}

std::optional<double> QuestionForm::estimate_mm() const {
  return estimate_->value() > 0.0 ? std::optional(estimate_->value()) : std::nullopt;
}

std::vector<core::EventContent> QuestionForm::Said() const {
  std::vector<core::EventContent> said;
  if (const auto estimate = estimate_mm()) said.emplace_back(core::EstimateGiven{when_, *estimate});
  for (const Question& question : questions_)
    if (const auto answer = question.answer()) said.push_back(question.event(*answer));
  return said;
}

void QuestionForm::FocusEstimate() {
  estimate_->setFocus(Qt::OtherFocusReason);
  estimate_->selectAll();
}

}  // namespace elbowroom::console
