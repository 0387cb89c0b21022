// The steps of the trial's procedure, and what the participant was asked.
#include <fmt/format.h>

#include <algorithm>

#include "core/procedure/answers.h"
#include "core/procedure/scores.h"
#include "core/procedure/step_runs.h"
#include "sessions/report/report_document.h"
#include "sessions/report/verdict_text.h"

namespace elbowroom::sessions {
namespace {

std::string Seconds(double time_s) { return fmt::format("{:.1f} s", time_s); }

void AddSteps(const ReportData& data, std::vector<Block>* blocks) {
  const std::vector<core::StepRun> runs = core::StepRunsOf(data.events);
  DocumentTable table{{{"Step"}, {"Begun", true}, {"Ended", true}, {"For", true}}, {}};
  const auto row = [&](const std::string& step, const std::string& begun, const std::string& ended,
                       const std::string& lasted) {
    table.rows.push_back({{NameText(step), begun, ended, lasted}});
  };
  for (const core::StepRun& run : runs)
    row(run.step, Seconds(run.begin_s), run.end_s ? Seconds(*run.end_s) : kNothing,
        run.duration_s() ? Seconds(*run.duration_s()) : kNothing);
  for (const std::string& step : data.header.trial.steps)
    if (std::ranges::find(runs, step, &core::StepRun::step) == runs.end())
      row(step, "not begun", kNothing, kNothing);
  if (!table.rows.empty()) blocks->push_back(std::move(table));
}

std::string EstimateText(const std::optional<double>& estimate_mm) {
  return estimate_mm ? Millimetres(*estimate_mm) : kNothing;
}

void AddAnswers(const ReportData& data, std::vector<Block>* blocks) {
  DocumentTable table{{{"Asked of the participant"}, {"When"}, {"Scale", true}, {"Answer", true}}, {}};
  const core::Estimates estimates = core::EstimatesOf(data.header.trial, data.events);
  if (estimates.before_mm || estimates.after_mm)
    for (const auto& [when, estimate_mm] : {std::pair{core::AskedWhen::kBefore, estimates.before_mm},
                                            {core::AskedWhen::kAfter, estimates.after_mm}})
      table.rows.push_back({{"Space needed, estimated", std::string(core::ToString(when)), kNothing,
                             EstimateText(estimate_mm)}});
  const std::vector<std::optional<int>> answers = core::AnswersOf(data.header.trial, data.events);
  for (std::size_t i = 0; i < answers.size(); ++i) {
    const core::SurveyItem& item = data.header.trial.survey[i];
    RichText question;
    question += NameRun(item.item);
    table.rows.push_back({{std::move(question), std::string(core::ToString(item.when)),
                           fmt::format("{} to {}", item.least, item.most),
                           answers[i] ? std::to_string(*answers[i]) : kNothing}});
  }
  if (!table.rows.empty()) blocks->push_back(std::move(table));
}

std::string NumberText(double number) { return fmt::format("{:.4g}", number); }

std::string AsAsked(const core::QuestionnaireItem& item) {
  std::string asked(core::ToString(item.kind));
  if (item.kind == core::ItemKind::kScale) asked = fmt::format("{:g} to {:g}", item.least, item.most);
  return asked + (item.reversed ? ", reversed" : "");
}

// Scores first: they are what the questionnaire was made for.
void AddQuestionnaire(const ReportData& data, const core::Questionnaire& questionnaire,
                      std::vector<Block>* blocks) {
  const core::ItemAnswers answers = core::AnswersOf(questionnaire, data.events);
  const std::string when(core::ToString(questionnaire.when));
  DocumentTable scores{{{"Score"}, {"When"}, {"Rule"}, {"Value", true}}, {}};
  for (const core::Score& score : questionnaire.scores) {
    const auto value = core::ScoreOf(questionnaire, score, answers);
    scores.rows.push_back({{NameText(fmt::format("{}: {}", questionnaire.name, score.name)), when,
                            std::string(core::ToString(score.rule)), value ? NumberText(*value) : kNothing}});
  }
  if (!scores.rows.empty()) blocks->push_back(std::move(scores));
  DocumentTable table{{{"Questionnaire"}, {"When"}, {"Asked as"}, {"Answer"}, {"Counts as", true}}, {}};
  for (std::size_t i = 0; i < questionnaire.items.size(); ++i) {
    const core::QuestionnaireItem& item = questionnaire.items[i];
    const auto value = answers[i] ? core::ValueOf(item, *answers[i]) : std::nullopt;
    table.rows.push_back({{NameText(fmt::format("{}: {}", questionnaire.name, item.text)), when,
                           AsAsked(item), answers[i] ? NameText(core::TextOf(*answers[i])) : kNothing,
                           value ? NumberText(*value) : kNothing}});
  }
  blocks->push_back(std::move(table));
}

}  // namespace

Section ProcedureSection(const ReportData& data) {
  Section section{.id = "procedure", .blocks = {}};
  AddSteps(data, &section.blocks);
  AddAnswers(data, &section.blocks);
  for (const core::Questionnaire& questionnaire : data.header.trial.questionnaires)
    AddQuestionnaire(data, questionnaire, &section.blocks);
  if (!section.blocks.empty())
    section.blocks.insert(section.blocks.begin(), Heading{"Procedure and participant"});
  return section;
}

}  // namespace elbowroom::sessions
