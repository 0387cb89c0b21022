// A questionnaire: what is asked, on which scales, and which scores are computed of the answers.
#pragma once

#include <string>
#include <variant>
#include <vector>

namespace elbowroom::core {

// Whether participants are asked before the first frame or after the last one.
enum class AskedWhen { kBefore, kAfter };

enum class ItemKind {
  kScale,   // a whole number from `least` to `most`
  kChoice,  // one of `choices`
  kNumber,  // from `least` to `most`
  kText,    // free; it has no value, so no score counts it
};

inline constexpr double kLargestAnswer = 1e9;  // of a number; no end of a range is farther from 0

// A number of a scale or a number; the text of a choice or a text.
using ItemAnswer = std::variant<double, std::string>;

// No two of a questionnaire have the same `id`.
struct QuestionnaireItem {
  std::string id;  // by which files and scores name it
  std::string text;
  ItemKind kind = ItemKind::kScale;
  double least = 1.0;             // of what answers are worth; of a choice the ends of `values`; a text: 0
  double most = 7.0;              // > least; a text: 0
  std::string least_anchor = {};  // the words at a scale's ends; may be empty
  std::string most_anchor = {};
  std::vector<std::string> choices = {};  // of a choice: at least two; they differ
  std::vector<double> values = {};        // what each choice is worth
  bool reversed = false;                  // an answer worth v counts as least + most - v; never of a text

  [[nodiscard]] bool operator==(const QuestionnaireItem&) const = default;
};

enum class ScoreRule {
  kSum,    // factor · Σ weight · value
  kMean,   // factor · Σ weight · value / Σ weight
  kCount,  // factor · the number of values from `counted_from` to `counted_to`
};

struct ScoreTerm {
  std::string item;     // the id of one that has a value; each once a score
  double weight = 1.0;  // of a sum: not 0; of a mean: > 0; of a count: 1

  [[nodiscard]] bool operator==(const ScoreTerm&) const = default;
};

// There is a score where all its items are answered.
struct Score {
  std::string name;
  ScoreRule rule = ScoreRule::kSum;
  std::vector<ScoreTerm> terms;  // at least one
  double factor = 1.0;           // not 0
  double counted_from = 0.0;     // of a count, both ends included; else 0
  double counted_to = 0.0;

  [[nodiscard]] bool operator==(const Score&) const = default;
};

// No two of a trial have the same `when` and `name`.
struct Questionnaire {
  AskedWhen when = AskedWhen::kAfter;
  std::string name;
  std::vector<QuestionnaireItem> items;  // at least one
  std::vector<Score> scores = {};        // their names differ

  [[nodiscard]] bool operator==(const Questionnaire&) const = default;
};

}  // namespace elbowroom::core
