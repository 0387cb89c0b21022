#include "core/procedure/scores.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "core/error.h"

namespace elbowroom::core {
namespace {

constexpr std::array kKinds = {ItemKind::kScale, ItemKind::kChoice, ItemKind::kNumber, ItemKind::kText};
constexpr std::array kRules = {ScoreRule::kSum, ScoreRule::kMean, ScoreRule::kCount};
constexpr std::size_t kLongestAnswer = 10'000;  // bytes of a text

template <typename Word, std::size_t n>
std::optional<Word> Parsed(const std::array<Word, n>& words, std::string_view text) {
  for (const Word word : words)
    if (text == ToString(word)) return word;
  return std::nullopt;
}

bool AreSameButForCase(std::string_view a, std::string_view b) {
  const auto lower = [](char letter) {
    return letter >= 'A' && letter <= 'Z' ? static_cast<char>(letter - 'A' + 'a') : letter;
  };
  return std::ranges::equal(a, b, {}, lower, lower);
}

bool IsInRange(const QuestionnaireItem& item, double number) {
  return number >= item.least && number <= item.most;
}

std::optional<double> NumberIn(std::string_view text) {
  double number = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return number;
}

// The place of the choice with these words, or else, if there is just one, of that which is worth the number.
std::optional<std::size_t> ChoiceIn(const QuestionnaireItem& item, std::string_view text) {
  const auto place = [&](auto at) { return static_cast<std::size_t>(at - item.choices.begin()); };
  if (const auto at = std::ranges::find(item.choices, text); at != item.choices.end()) return place(at);
  const auto at = std::ranges::find_if(
      item.choices, [&](const std::string& choice) { return AreSameButForCase(choice, text); });
  if (at != item.choices.end()) return place(at);
  const auto number = NumberIn(text);
  if (!number || std::ranges::count(item.values, *number) != 1) return std::nullopt;
  return static_cast<std::size_t>(std::ranges::find(item.values, *number) - item.values.begin());
}

// Its place among the choices.
std::optional<std::size_t> ChoiceOf(const QuestionnaireItem& item, const ItemAnswer& answer) {
  const auto* text = std::get_if<std::string>(&answer);
  if (text == nullptr) return std::nullopt;
  const auto at = std::ranges::find(item.choices, *text);
  if (at == item.choices.end()) return std::nullopt;
  return static_cast<std::size_t>(at - item.choices.begin());
}

}  // namespace

std::string_view ToString(ItemKind kind) {
  switch (kind) {
    case ItemKind::kScale:
      return "scale";
    case ItemKind::kChoice:
      return "choice";
    case ItemKind::kNumber:
      return "number";
    case ItemKind::kText:
      return "text";
  }
  return "";
}

std::optional<ItemKind> ParseItemKind(std::string_view text) { return Parsed(kKinds, text); }

std::string_view ToString(ScoreRule rule) {
  switch (rule) {
    case ScoreRule::kSum:
      return "sum";
    case ScoreRule::kMean:
      return "mean";
    case ScoreRule::kCount:
      return "count";
  }
  return "";
}

std::optional<ScoreRule> ParseScoreRule(std::string_view text) { return Parsed(kRules, text); }

const Questionnaire* FindQuestionnaire(const TrialInfo& trial, AskedWhen when, std::string_view name) {
  const auto at = std::ranges::find_if(trial.questionnaires, [&](const Questionnaire& other) {
    return other.when == when && other.name == name;
  });
  return at == trial.questionnaires.end() ? nullptr : &*at;
}

const QuestionnaireItem* FindItem(const Questionnaire& questionnaire, std::string_view id) {
  const auto at = std::ranges::find(questionnaire.items, id, &QuestionnaireItem::id);
  return at == questionnaire.items.end() ? nullptr : &*at;
}

std::string AnswersInWords(const QuestionnaireItem& item) {
  switch (item.kind) {
    case ItemKind::kScale:
      return fmt::format("a whole number from {:g} to {:g}", item.least, item.most);
    case ItemKind::kNumber:
      return fmt::format("a number from {:g} to {:g}", item.least, item.most);
    case ItemKind::kText:
      return fmt::format("a text of 1 to {} bytes", kLongestAnswer);
    case ItemKind::kChoice:
      break;
  }
  std::string words;
  for (const std::string& choice : item.choices)
    words += fmt::format("{}'{}'", words.empty() ? "" : " or ", choice);
  return words;
}

bool CanBe(const QuestionnaireItem& item, const ItemAnswer& answer) {
  const auto* number = std::get_if<double>(&answer);
  switch (item.kind) {
    case ItemKind::kScale:
      return number != nullptr && IsInRange(item, *number) && *number == std::floor(*number);
    case ItemKind::kNumber:
      return number != nullptr && IsInRange(item, *number);
    case ItemKind::kChoice:
      return ChoiceOf(item, answer).has_value();
    case ItemKind::kText:
      break;
  }
  return number == nullptr && !std::get<std::string>(answer).empty() &&
         std::get<std::string>(answer).size() <= kLongestAnswer;
}

std::optional<ItemAnswer> ParseAnswer(const QuestionnaireItem& item, std::string_view text) {
  std::optional<ItemAnswer> answer;
  switch (item.kind) {
    case ItemKind::kScale:
    case ItemKind::kNumber:
      if (const auto number = NumberIn(text)) answer = *number;
      break;
    case ItemKind::kChoice:
      if (const auto choice = ChoiceIn(item, text)) answer = item.choices[*choice];
      break;
    case ItemKind::kText:
      answer = std::string(text);
      break;
  }
  return answer && CanBe(item, *answer) ? answer : std::nullopt;
}

std::string TextOf(const ItemAnswer& answer) {
  const auto* number = std::get_if<double>(&answer);
  return number != nullptr ? fmt::format("{}", *number) : std::get<std::string>(answer);
}

std::optional<double> ValueOf(const QuestionnaireItem& item, const ItemAnswer& answer) {
  Require(CanBe(item, answer), "the item can have the answer");
  if (item.kind == ItemKind::kText) return std::nullopt;
  const auto* number = std::get_if<double>(&answer);
  const double value = number != nullptr ? *number : item.values.at(*ChoiceOf(item, answer));
  return item.reversed ? item.least + item.most - value : value;
}

ItemAnswers AnswersOf(const Questionnaire& questionnaire, std::span<const SessionEvent> events) {
  ItemAnswers answers(questionnaire.items.size());
  for (const SessionEvent& event : events) {
    const auto* answered = std::get_if<QuestionnaireAnswered>(&event.what);
    if (answered == nullptr || answered->when != questionnaire.when ||
        answered->questionnaire != questionnaire.name)
      continue;
    if (const QuestionnaireItem* item = FindItem(questionnaire, answered->item))
      answers[static_cast<std::size_t>(item - questionnaire.items.data())] = answered->answer;
  }
  return answers;
}

std::optional<double> ScoreOf(const Questionnaire& questionnaire, const Score& score,
                              const ItemAnswers& answers) {
  Require(answers.size() == questionnaire.items.size(), "one answer an item");
  double sum = 0.0, weights = 0.0;
  for (const ScoreTerm& term : score.terms) {
    const QuestionnaireItem* item = FindItem(questionnaire, term.item);
    Require(item != nullptr, "a score's items are the questionnaire's");
    const auto& answer = answers[static_cast<std::size_t>(item - questionnaire.items.data())];
    const auto value = answer ? ValueOf(*item, *answer) : std::nullopt;
    if (!value) return std::nullopt;
    const bool is_counted = *value >= score.counted_from && *value <= score.counted_to;
    sum += score.rule == ScoreRule::kCount ? (is_counted ? 1.0 : 0.0) : term.weight * *value;
    weights += term.weight;
  }
  return score.factor * (score.rule == ScoreRule::kMean ? sum / weights : sum);
}

}  // namespace elbowroom::core
