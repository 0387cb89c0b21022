// QUESTIONNAIRE.toml: what it may say, and that the samples are such files.
#include "app/control/procedure/questionnaire_file.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "core/error.h"
#include "core/procedure/scores.h"
#include "tests/support/places.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_file.h"

namespace elbowroom::control {
namespace {

namespace fs = std::filesystem;
using core::AskedWhen;
using core::ItemKind;

core::Questionnaire Read(const std::string& text) {
  const test_support::TemporaryFolder folder;
  test_support::WriteText(folder / "Q.toml", text);
  return ReadQuestionnaireFile(folder / "Q.toml", AskedWhen::kAfter);
}

std::string FaultOfFile(const std::string& text) {
  try {
    (void)Read(text);
  } catch (const core::Error& error) {
    return error.what();
  }
  return "";
}

constexpr const char* kAll = R"(name = "all"
[[item]]
id = "there"
text = "I was there"
anchors = ["not at all", "very much"]
[[item]]
id = "lab"
text = "I noticed the laboratory"
scale = [-3, 3]
reversed = true
[[item]]
id = "sick"
text = "Nausea"
kind = "choice"
choices = ["none", "slight", "severe"]
[[item]]
id = "figure"
text = "Which one?"
kind = "choice"
choices = ["a", "b"]
values = [0, 1]
[[item]]
id = "age"
text = "Age"
kind = "number"
range = [0, 120]
[[item]]
id = "words"
text = "What was in the way?"
kind = "text"
[[score]]
name = "high"
rule = "count"
counted = [6, 7]
[[score]]
name = "total"
rule = "sum"
items = ["sick", "lab"]
weights = [2, -1]
factor = 3.74
)";

TEST(QuestionnaireFile, HasEveryKindOfItemAndScore) {
  const core::Questionnaire read = Read(kAll);
  EXPECT_EQ(read.name, "all");
  ASSERT_EQ(read.items.size(), 6U);
  core::QuestionnaireItem there{"there", "I was there"};
  there.least_anchor = "not at all";
  there.most_anchor = "very much";
  EXPECT_EQ(read.items[0], there);
  EXPECT_TRUE(read.items[1].reversed);
  EXPECT_EQ(read.items[1].least, -3.0);
  EXPECT_EQ(read.items[2].values, (std::vector{0.0, 1.0, 2.0}));
  EXPECT_EQ(read.items[2].most, 2.0);
  EXPECT_EQ(read.items[3].most, 1.0);
  EXPECT_EQ(read.items[4].kind, ItemKind::kNumber);
  EXPECT_EQ(read.items[5].kind, ItemKind::kText);
  ASSERT_EQ(read.scores.size(), 2U);
  EXPECT_EQ(read.scores[0].terms.size(), 5U) << "all but the text";
  EXPECT_EQ(read.scores[1].terms, (std::vector<core::ScoreTerm>{{"sick", 2.0}, {"lab", -1.0}}));
  EXPECT_EQ(read.scores[1].factor, 3.74);
}

TEST(QuestionnaireFile, WhatIsWrongIsOneLineWithItsPlace) {
  const auto with = [](const std::string& was, const std::string& now) {
    std::string text = kAll;
    EXPECT_NE(text.find(was), std::string::npos) << was;
    return text.replace(text.find(was), was.size(), now);
  };
  for (const auto& [text, said] :
       {std::pair{with("name = \"all\"", ""), "key 'name' is missing"},
        std::pair{with("id = \"lab\"", "id = \"there\""),
                  "Q.toml:7: [[item]]: key 'id' 'there' is the id of an "
                  "earlier item"},
        std::pair{with("id = \"lab\"", "id = \"the lab\""), "only letters, digits"},
        std::pair{with("text = \"Age\"", ""), "key 'text' is missing"},
        std::pair{with("kind = \"text\"", "kind = \"words\""),
                  "\"scale\", \"choice\", \"number\" or \"text\""},
        std::pair{with("kind = \"text\"", "kind = \"text\"\nreversed = true"), "a text hasn't"},
        std::pair{with("range = [0, 120]", "reversed = true"), "needs the number's range"},
        std::pair{with("range = [0, 120]", "range = [120, 0]"), "two numbers, the least first"},
        std::pair{with("range = [0, 120]", "scale = [0, 120]"), "key 'scale' is for a scale; leave it out"},
        std::pair{with("scale = [-3, 3]", "scale = [3, -3]"), "two whole numbers"},
        std::pair{with("[\"not at all\", \"very much\"]", "[\"not at all\"]"), "must be two texts"},
        std::pair{with("[\"a\", \"b\"]", "[\"a\"]"), "a list of 2 to 50 texts"},
        std::pair{with("[\"a\", \"b\"]", "[\"a\", \"a\"]"), "has 'a' twice"},
        std::pair{with("values = [0, 1]", "values = [0, 1, 2]"), "has 3 numbers for 2 choices"},
        std::pair{with("values = [0, 1]", "values = [1, 1]"), "are all the same"},
        std::pair{with("values = [0, 1]", "valeus = [0, 1]"), "did you mean 'values'?"},
        std::pair{with("rule = \"sum\"", "rule = \"product\""), "\"sum\", \"mean\" or \"count\""},
        std::pair{with("counted = [6, 7]", ""), "key 'counted' is missing"},
        std::pair{with("factor = 3.74", "counted = [1, 2]"), "is for a count"},
        std::pair{with("factor = 3.74", "factor = 0"), "must not be 0"},
        std::pair{with("[\"sick\", \"lab\"]", "[\"sick\", \"labs\"]"), "names 'labs', which no [[item]] has"},
        std::pair{with("[\"sick\", \"lab\"]", "[\"sick\", \"words\"]"),
                  "'words', a text, which has no value"},
        std::pair{with("[\"sick\", \"lab\"]", "[\"sick\", \"sick\"]"), "names 'sick' twice"},
        std::pair{with("weights = [2, -1]", "weights = [2]"), "has 1 numbers for 2 items"},
        std::pair{with("weights = [2, -1]", "weights = [2, 0]"), "must not be 0"},
        std::pair{with("name = \"total\"", "name = \"high\""), "name of an earlier score"},
        std::pair{std::string("name = \"empty\"\n"), "key 'item' is missing"},
        std::pair{std::string("name = \n"), "Q.toml:1: not TOML"}}) {
    const std::string fault = FaultOfFile(text);
    EXPECT_NE(fault.find(said), std::string::npos) << said << " in " << fault;
    EXPECT_NE(fault.find("Q.toml:"), std::string::npos) << fault;
    EXPECT_EQ(std::ranges::count(fault, '\n'), 0) << fault;
  }
}

TEST(QuestionnaireFile, EverySampleCanBeAskedAndScored) {
  int samples = 0;
  for (const auto& entry :
       fs::directory_iterator(test_support::SourceFolder() / "docs/examples/questionnaires")) {
    const core::Questionnaire sample = ReadQuestionnaireFile(entry.path(), AskedWhen::kAfter);
    core::ItemAnswers answers;
    for (const core::QuestionnaireItem& item : sample.items) {
      if (item.kind == ItemKind::kText)
        answers.emplace_back("words");
      else if (item.kind == ItemKind::kChoice)
        answers.emplace_back(item.choices.back());
      else
        answers.emplace_back(item.most);
    }
    for (const core::Score& score : sample.scores)
      EXPECT_TRUE(core::ScoreOf(sample, score, answers).has_value()) << entry.path() << score.name;
    if (entry.path().filename() == "sickness.toml") {
      EXPECT_DOUBLE_EQ(*core::ScoreOf(sample, sample.scores[0], answers), 9.54 * 9.0);
      EXPECT_DOUBLE_EQ(*core::ScoreOf(sample, sample.scores[3], answers), 3.74 * 27.0)
          << "the sum of the three raw scales";
    }
    ++samples;
  }
  EXPECT_EQ(samples, 4);
}

}  // namespace
}  // namespace elbowroom::control
