#include "sessions/event_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/file_limits.h"
#include "core/procedure/answers.h"
#include "core/procedure/event_text.h"
#include "core/procedure/scores.h"
#include "sessions/database/damage.h"
#include "sessions/database/statement.h"
#include "sessions/questionnaire_rows.h"
#include "sessions/row_rules.h"

namespace elbowroom::sessions {
namespace {

// The columns of kEventsSql, in order.
enum Column : int {
  kFrame,
  kTime,
  kKind,
  kSpacing,
  kFrom,
  kTo,
  kTool,
  kInUse,
  kNote,
  kStep,
  kBegun,
  kBookmark,
  kAsked,
  kEstimate,
  kItemAsked,
  kItem,
  kLeast,
  kMost,
  kAnswer,
  kQuestion,
  kNumber,
  kText
};
constexpr const char* kEventsSql =
    "SELECT e.frame_index, e.time_s, e.kind, s.name, e.from_mm, e.to_mm, e.tool, e.in_use, e.note, t.name, "
    "e.begun, e.bookmark, e.asked, e.estimate_mm, i.asked, i.item, i.least, i.most, e.answer, "
    "e.question_index, e.answer_number, e.answer_text "
    "FROM event e LEFT JOIN spacing s USING (spacing_index) LEFT JOIN step t USING (step_index) "
    "LEFT JOIN survey_item i USING (item_index) ORDER BY e.frame_index, e.event_id";

// Every question of the trial, by its index.
using Questions = std::vector<std::pair<const core::Questionnaire*, const core::QuestionnaireItem*>>;

Questions QuestionsOf(const std::vector<core::Questionnaire>& questionnaires) {
  Questions questions;
  for (const core::Questionnaire& questionnaire : questionnaires)
    for (const core::QuestionnaireItem& item : questionnaire.items)
      questions.emplace_back(&questionnaire, &item);
  return questions;
}

core::AskedWhen AskedFrom(const std::string& text, const std::string& where) {
  const auto when = core::ParseAskedWhen(text);
  if (!when) FailAsDamaged(where, fmt::format("it was asked '{}' the trial", Quotable(text)));
  return *when;
}

core::SurveyAnswered ReadAnswer(const Statement& row, const std::string& where) {
  const std::int64_t answer = row.Integer(kAnswer);
  if (answer < row.Integer(kLeast) || answer > row.Integer(kMost))
    FailAsDamaged(where, fmt::format("the answer {} isn't on the scale of its item", answer));
  return {AskedFrom(row.Text(kItemAsked), where), row.Text(kItem), static_cast<int>(answer)};
}

core::QuestionnaireAnswered ReadQuestionnaireAnswer(const Statement& row, const Questions& questions,
                                                    const std::string& where) {
  const auto& [questionnaire, item] =
      questions[IndexBelow(row.Integer(kQuestion), questions.size(), where, "question")];
  core::ItemAnswer answer = 0.0;
  if (row.IsNull(kNumber))
    answer = row.Text(kText);
  else
    answer = row.Real(kNumber);
  if (!core::CanBe(*item, answer))
    FailAsDamaged(where, fmt::format("question '{}' can't have the answer '{}'", Quotable(item->id),
                                     Quotable(core::TextOf(answer))));
  return {questionnaire->when, questionnaire->name, item->id, std::move(answer)};
}

core::EventContent ReadContent(const Statement& row, const Questions& questions, const std::string& where) {
  const std::string kind = row.Text(kKind);
  if (kind == "spacing")
    return core::SpacingChanged{row.Text(kSpacing), GapMm(row.Real(kFrom), where, "a spacing"),
                                GapMm(row.Real(kTo), where, "a spacing")};
  if (kind == "tool") return core::ToolMarked{row.Text(kTool), row.Integer(kInUse) != 0};
  if (kind == "note") return core::Note{row.Text(kNote)};
  if (kind == "step") return core::StepMarked{row.Text(kStep), row.Integer(kBegun) != 0};
  if (kind == "bookmark") return core::Bookmark{row.Text(kBookmark)};
  if (kind == "estimate")
    return core::EstimateGiven{AskedFrom(row.Text(kAsked), where),
                               GapMm(row.Real(kEstimate), where, "an estimate")};
  if (kind == "answer") return ReadAnswer(row, where);
  if (kind == "questionnaire") return ReadQuestionnaireAnswer(row, questions, where);
  FailAsDamaged(where, fmt::format("no event is called '{}'", Quotable(kind)));
}

std::size_t StepIndexOf(const core::TrialInfo& trial, const std::string& step) {
  const auto at = std::ranges::find(trial.steps, step);
  core::Require(at != trial.steps.end(), "a step is one of the trial's");
  return static_cast<std::size_t>(at - trial.steps.begin());
}

std::size_t ItemIndexOf(const core::TrialInfo& trial, const core::SurveyAnswered& answered) {
  const core::SurveyItem* item = core::FindItem(trial, answered.when, answered.item);
  core::Require(item != nullptr, "an answer is to an item of the trial's survey");
  core::Require(answered.answer >= item->least && answered.answer <= item->most,
                "an answer is on the scale of its item");
  return static_cast<std::size_t>(item - trial.survey.data());
}

std::size_t QuestionIndexOf(const core::TrialInfo& trial, const core::QuestionnaireAnswered& answered) {
  const core::Questionnaire* questionnaire =
      core::FindQuestionnaire(trial, answered.when, answered.questionnaire);
  core::Require(questionnaire != nullptr, "an answer is to a questionnaire of the trial");
  const core::QuestionnaireItem* item = core::FindItem(*questionnaire, answered.item);
  core::Require(item != nullptr, "an answer is to an item of its questionnaire");
  core::Require(core::CanBe(*item, answered.answer), "an answer is one that its item can have");
  const Questions questions = QuestionsOf(trial.questionnaires);
  return static_cast<std::size_t>(std::ranges::find(questions, item, &Questions::value_type::second) -
                                  questions.begin());
}

// Inserts what each kind of event has of its own.
struct Inserter {
  Database& database;
  const core::SessionHeader& header;
  const core::SessionEvent& event;

  template <typename... Values>
  void Insert(const char* columns, const Values&... values) const {
    std::string sql =
        fmt::format("INSERT INTO event (frame_index, time_s, kind, {}) VALUES (?, ?, ?", columns);
    for (std::size_t i = 0; i < sizeof...(values); ++i) sql += ", ?";
    Statement(database, sql + ")").With(event.frame, event.time_s, core::KindOf(event.what), values...).Run();
  }
  void operator()(const core::SpacingChanged& change) const {
    Insert("spacing_index, from_mm, to_mm", header.layout.FindSpacing(change.spacing), change.from_mm,
           change.to_mm);
  }
  void operator()(const core::ToolMarked& mark) const { Insert("tool, in_use", mark.tool, mark.in_use); }
  void operator()(const core::Note& note) const { Insert("note", note.text); }
  void operator()(const core::StepMarked& mark) const {
    Insert("step_index, begun", StepIndexOf(header.trial, mark.step), mark.begun);
  }
  void operator()(const core::Bookmark& bookmark) const { Insert("bookmark", bookmark.name); }
  void operator()(const core::EstimateGiven& given) const {
    Insert("asked, estimate_mm", core::ToString(given.when), given.estimate_mm);
  }
  void operator()(const core::SurveyAnswered& answered) const {
    Insert("item_index, answer", ItemIndexOf(header.trial, answered), answered.answer);
  }
  void operator()(const core::QuestionnaireAnswered& answered) const {
    const std::size_t question = QuestionIndexOf(header.trial, answered);
    if (const auto* number = std::get_if<double>(&answered.answer))
      Insert("question_index, answer_number", question, *number);
    else
      Insert("question_index, answer_text", question, std::get<std::string>(answered.answer));
  }
};

}  // namespace

void RequireOfSetUp(const core::EventContent& what, const core::SessionHeader& header) {
  if (const auto* change = std::get_if<core::SpacingChanged>(&what))
    core::Require(header.layout.FindSpacing(change->spacing).has_value(),
                  "a changed spacing is one of the layout's");
  if (const auto* mark = std::get_if<core::StepMarked>(&what)) (void)StepIndexOf(header.trial, mark->step);
  if (const auto* given = std::get_if<core::EstimateGiven>(&what))
    core::Require(given->estimate_mm > 0.0 && given->estimate_mm <= core::kLongestLengthMm,
                  "an estimate is above 0 and at most kLongestLengthMm");
  if (const auto* answered = std::get_if<core::SurveyAnswered>(&what))
    (void)ItemIndexOf(header.trial, *answered);
  if (const auto* answered = std::get_if<core::QuestionnaireAnswered>(&what))
    (void)QuestionIndexOf(header.trial, *answered);
}

void InsertEvent(Database& database, const core::SessionHeader& header, const core::SessionEvent& event) {
  RequireOfSetUp(event.what, header);
  std::visit(Inserter{database, header, event}, event.what);
}

std::vector<core::SessionEvent> ReadEvents(Database& database) {
  const std::vector<core::Questionnaire> questionnaires = ReadQuestionnaires(database);
  const Questions questions = QuestionsOf(questionnaires);
  Statement rows(database, kEventsSql);
  const std::string where = fmt::format("session '{}', an event", database.path().string());
  std::vector<core::SessionEvent> events;
  while (rows.Next())
    events.push_back({CountFrom(0, rows.Integer(kFrame), where, "an event's frame"),
                      Time_s(rows.Real(kTime), where, "an event's time"),
                      ReadContent(rows, questions, where)});
  return events;
}

}  // namespace elbowroom::sessions
