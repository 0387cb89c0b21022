// Answers to questionnaires, what they are worth, and the scores computed of them.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/session.h"

namespace elbowroom::core {

[[nodiscard]] std::string_view ToString(ItemKind kind);  // "scale", "choice", "number", "text"
[[nodiscard]] std::optional<ItemKind> ParseItemKind(std::string_view text);
[[nodiscard]] std::string_view ToString(ScoreRule rule);  // "sum", "mean", "count"
[[nodiscard]] std::optional<ScoreRule> ParseScoreRule(std::string_view text);

// Null if the trial, or the questionnaire, has none of that name.
[[nodiscard]] const Questionnaire* FindQuestionnaire(const TrialInfo& trial, AskedWhen when,
                                                     std::string_view name);
[[nodiscard]] const QuestionnaireItem* FindItem(const Questionnaire& questionnaire, std::string_view id);

// What answers the item can have, in words: "a whole number from 1 to 7", "'none' or 'slight'".
[[nodiscard]] std::string AnswersInWords(const QuestionnaireItem& item);

[[nodiscard]] bool CanBe(const QuestionnaireItem& item, const ItemAnswer& answer);

// The answer that a text says; of a choice its words, in any case of ASCII letters, or what it is worth, if
// only one is worth that. Nothing: the item can't have it.
[[nodiscard]] std::optional<ItemAnswer> ParseAnswer(const QuestionnaireItem& item, std::string_view text);

[[nodiscard]] std::string TextOf(const ItemAnswer& answer);

// What an answer that the item can have counts in scores, reversed where the item is. Nothing: a text.
[[nodiscard]] std::optional<double> ValueOf(const QuestionnaireItem& item, const ItemAnswer& answer);

using ItemAnswers = std::vector<std::optional<ItemAnswer>>;

// One an item, in their order. The last event holds; nothing: it wasn't answered.
[[nodiscard]] ItemAnswers AnswersOf(const Questionnaire& questionnaire, std::span<const SessionEvent> events);

// `answers`: one an item. Nothing where an item that counts isn't answered.
[[nodiscard]] std::optional<double> ScoreOf(const Questionnaire& questionnaire, const Score& score,
                                            const ItemAnswers& answers);

}  // namespace elbowroom::core
