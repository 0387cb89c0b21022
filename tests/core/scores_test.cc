#include "core/procedure/scores.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "core/error.h"
#include "core/procedure/event_text.h"

namespace elbowroom::core {
namespace {

QuestionnaireItem Choice(const std::string& id) {
  QuestionnaireItem item{id, id, ItemKind::kChoice, 0.0, 3.0};
  item.choices = {"None", "Slight", "Moderate", "Severe"};
  item.values = {0.0, 1.0, 2.0, 3.0};
  return item;
}

Questionnaire Presence() {
  QuestionnaireItem there{"there", "there"}, lab{"lab", "lab"};
  lab.reversed = true;
  return {AskedWhen::kAfter,
          "presence",
          {there,
           lab,
           {"words", "words", ItemKind::kText, 0.0, 0.0},
           {"age", "age", ItemKind::kNumber, 0.0, 150.0}},
          {{"mean", ScoreRule::kMean, {{"there"}, {"lab", 2.0}}},
           {"sum", ScoreRule::kSum, {{"there"}, {"lab"}}, 0.5},
           {"high", ScoreRule::kCount, {{"there"}, {"lab"}}, 1.0, 6.0, 7.0}}};
}

std::optional<double> ScoreNamed(const std::string& name, const ItemAnswers& answers) {
  const Questionnaire presence = Presence();
  for (const Score& score : presence.scores)
    if (score.name == name) return ScoreOf(presence, score, answers);
  throw std::runtime_error("no such score");
}

TEST(Scores, CountReversedItemsFromTheOtherEnd) {
  const ItemAnswers answers = {6.0, 2.0, std::nullopt, std::nullopt};
  EXPECT_EQ(ValueOf(Presence().items[1], 2.0), 6.0);
  EXPECT_DOUBLE_EQ(*ScoreNamed("sum", answers), 0.5 * (6.0 + 6.0));
  EXPECT_DOUBLE_EQ(*ScoreNamed("mean", {7.0, 2.0, std::nullopt, std::nullopt}), (7.0 + 2.0 * 6.0) / 3.0);
}

// Slater, Usoh and Steed's count: how many of the answers are 6 or 7.
TEST(Scores, CountHighAnswers) {
  EXPECT_EQ(ScoreNamed("high", {6.0, 1.0, {}, {}}), 2.0);
  EXPECT_EQ(ScoreNamed("high", {5.0, 1.0, {}, {}}), 1.0);
  EXPECT_EQ(ScoreNamed("high", {5.0, 7.0, {}, {}}), 0.0);
}

TEST(Scores, AreNoneWhereAnItemThatCountsIsNotAnswered) {
  EXPECT_EQ(ScoreNamed("sum", {6.0, std::nullopt, {}, {}}), std::nullopt);
  EXPECT_TRUE(ScoreNamed("sum", {6.0, 6.0, {}, {}}).has_value());
}

// Kennedy and others' three scales share items, and the total weighs those of two scales twice: 3.74 times
// the sum of the raw scales.
TEST(Scores, OfSharedItemsAreThoseOfThePublishedWeights) {
  Questionnaire sickness{AskedWhen::kAfter, "sickness", {}};
  for (const char* id : {"discomfort", "eyes", "dizzy"}) sickness.items.push_back(Choice(id));
  const Score nausea{"nausea", ScoreRule::kSum, {{"discomfort"}}, 9.54};
  const Score total{"total", ScoreRule::kSum, {{"discomfort", 2.0}, {"eyes"}, {"dizzy"}}, 3.74};
  const ItemAnswers answers = {"Severe", "Slight", "None"};
  EXPECT_DOUBLE_EQ(*ScoreOf(sickness, nausea, answers), 9.54 * 3.0);
  EXPECT_DOUBLE_EQ(*ScoreOf(sickness, total, answers), 3.74 * (3.0 + (3.0 + 1.0) + 0.0));
}

TEST(Scores, TheLastAnswerHolds) {
  const auto answered = [](const char* item, ItemAnswer answer) {
    return SessionEvent{0, 0.0,
                        QuestionnaireAnswered{AskedWhen::kAfter, "presence", item, std::move(answer)}};
  };
  std::vector<SessionEvent> events = {answered("there", 2.0), answered("words", "it was warm"),
                                      answered("there", 3.0), answered("nothing", 1.0)};
  events.push_back({0, 0.0, QuestionnaireAnswered{AskedWhen::kBefore, "presence", "lab", 1.0}});
  EXPECT_EQ(AnswersOf(Presence(), events), (ItemAnswers{3.0, {}, "it was warm", {}}));
  EXPECT_EQ(EventText(events[0].what), "after the trial, presence, 'there': 2");
  EXPECT_EQ(KindOf(events[0].what), "questionnaire");
}

TEST(Answers, AreReadFromTexts) {
  const Questionnaire presence = Presence();
  const QuestionnaireItem& scale = presence.items[0];
  EXPECT_EQ(ParseAnswer(scale, "7"), ItemAnswer(7.0));
  for (const char* text : {"8", "0", "6.5", "six", "", "7 ", "nan", "0x3"})
    EXPECT_EQ(ParseAnswer(scale, text), std::nullopt) << text;
  EXPECT_EQ(ParseAnswer(presence.items[3], "31.5"), ItemAnswer(31.5));
  EXPECT_EQ(ParseAnswer(presence.items[3], "inf"), std::nullopt);
  EXPECT_EQ(ParseAnswer(presence.items[2], "31"), ItemAnswer("31"));
  EXPECT_EQ(ParseAnswer(presence.items[2], ""), std::nullopt);
  const QuestionnaireItem choice = Choice("eyes");
  EXPECT_EQ(ParseAnswer(choice, "slight"), ItemAnswer("Slight"));
  EXPECT_EQ(ParseAnswer(choice, "3"), ItemAnswer("Severe"));
  EXPECT_EQ(ParseAnswer(choice, "4"), std::nullopt);
  QuestionnaireItem right = choice;
  right.values = {0.0, 0.0, 1.0, 0.0};
  EXPECT_EQ(ParseAnswer(right, "1"), ItemAnswer("Moderate"));
  EXPECT_EQ(ParseAnswer(right, "0"), std::nullopt) << "three are worth that";
  EXPECT_EQ(AnswersInWords(scale), "a whole number from 1 to 7");
  EXPECT_EQ(AnswersInWords(choice), "'None' or 'Slight' or 'Moderate' or 'Severe'");
}

TEST(Answers, ThatAnItemCantHaveHaveNoValue) {
  EXPECT_THROW((void)ValueOf(Presence().items[0], ItemAnswer(9.0)), PreconditionError);
  EXPECT_EQ(ValueOf(Presence().items[2], ItemAnswer("words")), std::nullopt);
}

TEST(Kinds, AreReadAsTheyAreWritten) {
  for (const ItemKind kind : {ItemKind::kScale, ItemKind::kChoice, ItemKind::kNumber, ItemKind::kText})
    EXPECT_EQ(ParseItemKind(ToString(kind)), kind);
  for (const ScoreRule rule : {ScoreRule::kSum, ScoreRule::kMean, ScoreRule::kCount})
    EXPECT_EQ(ParseScoreRule(ToString(rule)), rule);
  EXPECT_EQ(ParseItemKind("picture"), std::nullopt);
}

}  // namespace
}  // namespace elbowroom::core
