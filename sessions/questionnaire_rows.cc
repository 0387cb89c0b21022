#include "sessions/questionnaire_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "core/procedure/answers.h"
#include "core/procedure/scores.h"
#include "sessions/database/damage.h"
#include "sessions/database/statement.h"
#include "sessions/packing.h"
#include "sessions/row_rules.h"

namespace elbowroom::sessions {
namespace {

using core::ItemKind;
using core::QuestionnaireItem;
using core::ScoreRule;

std::optional<double> OnlyIf(bool has_it, double value) {
  return has_it ? std::optional(value) : std::nullopt;
}

std::optional<std::string> OnlyIf(bool has_it, std::string value) {
  return has_it ? std::optional(std::move(value)) : std::nullopt;
}

// Numbers its rows over all questionnaires.
class QuestionnaireInserter {
 public:
  explicit QuestionnaireInserter(Database& database)
      : questionnaire_(database, "INSERT INTO questionnaire VALUES (?, ?, ?)"),
        question_(database, "INSERT INTO question VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)"),
        score_(database, "INSERT INTO score VALUES (?, ?, ?, ?, ?, ?, ?)"),
        term_(database, "INSERT INTO score_term VALUES (?, ?, ?, ?)") {}

  void Insert(const core::Questionnaire& questionnaire) {
    questionnaire_.With(questionnaires_, core::ToString(questionnaire.when), questionnaire.name).Run();
    for (std::size_t i = 0; i < questionnaire.items.size(); ++i)
      InsertItem(questions_ + i, questionnaire.items[i]);
    for (const core::Score& score : questionnaire.scores) InsertScore(questionnaire, score);
    questions_ += questionnaire.items.size();
    ++questionnaires_;
  }

 private:
  void InsertItem(std::size_t index, const QuestionnaireItem& item) {
    const bool has_value = item.kind != ItemKind::kText, has_choices = item.kind == ItemKind::kChoice;
    question_
        .With(index, questionnaires_, item.id, item.text, core::ToString(item.kind),
              OnlyIf(has_value, item.least), OnlyIf(has_value, item.most), item.least_anchor,
              item.most_anchor, OnlyIf(has_choices, JsonFrom(item.choices)),
              OnlyIf(has_choices, JsonFrom(item.values)), item.reversed)
        .Run();
  }

  void InsertScore(const core::Questionnaire& questionnaire, const core::Score& score) {
    const bool counts = score.rule == ScoreRule::kCount;
    score_
        .With(scores_, questionnaires_, score.name, core::ToString(score.rule), score.factor,
              OnlyIf(counts, score.counted_from), OnlyIf(counts, score.counted_to))
        .Run();
    for (std::size_t i = 0; i < score.terms.size(); ++i) {
      const auto item = std::ranges::find(questionnaire.items, score.terms[i].item, &QuestionnaireItem::id);
      const auto place = static_cast<std::size_t>(item - questionnaire.items.begin());
      term_.With(scores_, i, questions_ + place, score.terms[i].weight).Run();
    }
    ++scores_;
  }

  Statement questionnaire_, question_, score_, term_;
  std::size_t questionnaires_ = 0, questions_ = 0, scores_ = 0;
};

double Answerable(double value, const std::string& where) {
  if (!(std::abs(value) <= core::kLargestAnswer))
    FailAsDamaged(where, fmt::format("an end of a range is {:.6g}", value));
  return value;
}

// Where a question is kept: of which questionnaire, and which of its items.
struct QuestionPlace {
  std::size_t questionnaire = 0;
  std::size_t item = 0;
};

class QuestionnaireReader {
 public:
  explicit QuestionnaireReader(Database& database)
      : database_(database),
        where_(fmt::format("session '{}', its questionnaires", database.path().string())) {}

  std::vector<core::Questionnaire> Read() {
    Statement rows(database_,
                   "SELECT questionnaire_index, asked, name FROM questionnaire ORDER BY questionnaire_index");
    while (rows.Next()) {
      RequireInTurn(rows.Integer(0), read_.size(), where_, "questionnaire");
      const auto when = core::ParseAskedWhen(rows.Text(1));
      if (!when) FailAsDamaged(where_, fmt::format("one is asked '{}' the trial", Quotable(rows.Text(1))));
      read_.push_back({*when, rows.Text(2), {}});
    }
    ReadItems();
    ReadScores();
    ReadTerms();
    return std::move(read_);
  }

 private:
  void ReadItems() {
    Statement rows(database_,
                   "SELECT question_index, questionnaire_index, item, text, kind, least, most, least_anchor, "
                   "most_anchor, choices, choice_values, reversed FROM question ORDER BY question_index");
    while (rows.Next()) {
      RequireInTurn(rows.Integer(0), places_.size(), where_, "question");
      const std::size_t of = IndexBelow(rows.Integer(1), read_.size(), where_, "questionnaire");
      places_.push_back({of, read_[of].items.size()});
      read_[of].items.push_back(ItemOf(rows));
    }
  }

  QuestionnaireItem ItemOf(const Statement& row) const {
    QuestionnaireItem item{row.Text(2), row.Text(3)};
    const auto kind = core::ParseItemKind(row.Text(4));
    if (!kind) FailAsDamaged(where_, fmt::format("no question is of kind '{}'", Quotable(row.Text(4))));
    item.kind = *kind;
    const bool has_value = *kind != ItemKind::kText;
    item.least = has_value ? Answerable(row.Real(5), where_) : 0.0;
    item.most = has_value ? Answerable(row.Real(6), where_) : 0.0;
    item.least_anchor = row.Text(7);
    item.most_anchor = row.Text(8);
    if (*kind == ItemKind::kChoice) {
      item.choices = TextsFromJson(row.Text(9), where_);
      item.values = NumbersFromJson(row.Text(10), where_);
    }
    item.reversed = row.Integer(11) != 0;
    if (item.choices.size() != item.values.size() || (has_value && !(item.least < item.most)))
      FailAsDamaged(where_, fmt::format("question '{}' is none that can be asked", Quotable(item.id)));
    return item;
  }

  void ReadScores() {
    Statement rows(database_,
                   "SELECT score_index, questionnaire_index, name, rule, factor, counted_from, counted_to "
                   "FROM score ORDER BY score_index");
    while (rows.Next()) {
      RequireInTurn(rows.Integer(0), scores_.size(), where_, "score");
      const std::size_t of = IndexBelow(rows.Integer(1), read_.size(), where_, "questionnaire");
      const auto rule = core::ParseScoreRule(rows.Text(3));
      if (!rule) FailAsDamaged(where_, fmt::format("no score is a '{}'", Quotable(rows.Text(3))));
      const bool counts = *rule == ScoreRule::kCount;
      scores_.push_back({of, read_[of].scores.size()});
      read_[of].scores.push_back({rows.Text(2),
                                  *rule,
                                  {},
                                  rows.Real(4),
                                  counts ? Answerable(rows.Real(5), where_) : 0.0,
                                  counts ? Answerable(rows.Real(6), where_) : 0.0});
    }
  }

  void ReadTerms() {
    Statement rows(database_,
                   "SELECT score_index, term_index, question_index, weight FROM score_term "
                   "ORDER BY score_index, term_index");
    while (rows.Next()) {
      const QuestionPlace score = scores_[IndexBelow(rows.Integer(0), scores_.size(), where_, "score")];
      const QuestionPlace question = places_[IndexBelow(rows.Integer(2), places_.size(), where_, "question")];
      core::Questionnaire& of = read_[score.questionnaire];
      auto& terms = of.scores[score.item].terms;
      RequireInTurn(rows.Integer(1), terms.size(), where_, "term");
      if (question.questionnaire != score.questionnaire || of.items[question.item].kind == ItemKind::kText)
        FailAsDamaged(where_, fmt::format("score '{}' counts a question that it can't",
                                          Quotable(of.scores[score.item].name)));
      terms.push_back({of.items[question.item].id, rows.Real(3)});
    }
  }

  Database& database_;
  std::string where_;
  std::vector<core::Questionnaire> read_;
  std::vector<QuestionPlace> places_;  // of questions
  std::vector<QuestionPlace> scores_;  // likewise; `item` is the score's place
};

}  // namespace

void InsertQuestionnaires(Database& database, const std::vector<core::Questionnaire>& questionnaires) {
  QuestionnaireInserter inserter(database);
  for (const core::Questionnaire& questionnaire : questionnaires) inserter.Insert(questionnaire);
}

std::vector<core::Questionnaire> ReadQuestionnaires(Database& database) {
  return QuestionnaireReader(database).Read();
}

}  // namespace elbowroom::sessions
