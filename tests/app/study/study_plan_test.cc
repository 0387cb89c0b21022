// STUDY.toml: what it may say, and the balanced plan that comes of it.
#include "app/control/study_plan/study_plan.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "app/control/trial_setup.h"
#include "core/error.h"
#include "tests/support/places.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_file.h"

namespace elbowroom::control {
namespace {

namespace fs = std::filesystem;

constexpr const char* kWithin = R"(name = "gloves"
seed = 7
design = "within"
participants = 12
trial = "TRIAL.toml"
[[condition]]
name = "bare"
[[condition]]
name = "thin"
[[condition]]
name = "thick"
trial = "THICK.toml"
[[task]]
name = "2 x 2"
block = "practice"
[[task]]
name = "3 x 3"
block = "timed"
)";

class StudyPlanTest : public testing::Test {
 protected:
  void SetUp() override {
    for (const char* trial : {"TRIAL.toml", "THICK.toml"}) test_support::WriteText(folder_ / trial, "");
  }
  fs::path Write(const std::string& text) const {
    test_support::WriteText(folder_ / "STUDY.toml", text);
    return folder_ / "STUDY.toml";
  }
  [[nodiscard]] test_support::ProgramRun Plan(const std::vector<std::string>& more) const {
    std::vector<std::string> arguments{"plan", (folder_ / "STUDY.toml").string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return test_support::RunProgram(test_support::ProgramFile(), arguments);
  }
  test_support::TemporaryFolder folder_;
};

TEST_F(StudyPlanTest, WithinEachDoesAllInBalancedOrder) {
  const StudyPlan plan = ReadStudyPlan(Write(kWithin));
  EXPECT_EQ(plan.participants.front(), "P01");
  EXPECT_EQ(plan.participants.back(), "P12");
  EXPECT_EQ(BlockSizeOf(plan), 6U) << "three conditions: six orders";
  const std::vector<PlannedTrial> trials = PlannedTrials(plan);
  ASSERT_EQ(trials.size(), 12U * 3U * 2U);
  std::map<std::pair<std::string, int>, int> at_place;
  for (std::size_t i = 0; i < trials.size(); ++i) {
    const PlannedTrial& trial = trials[i];
    EXPECT_EQ(trial.participant, plan.participants[i / 6]);
    EXPECT_EQ(trial.order, static_cast<int>(i % 6) + 1);
    EXPECT_EQ(trial.block, i % 2 == 0 ? "practice" : "timed");
    EXPECT_EQ(trial.task, i % 2 == 0 ? "2 x 2" : "3 x 3");
    EXPECT_EQ(trial.trial_file.filename(), trial.condition == "thick" ? "THICK.toml" : "TRIAL.toml");
    ++at_place[{trial.condition, (trial.order - 1) / 2}];
  }
  EXPECT_EQ(at_place.size(), 9U);
  for (const auto& [which, times] : at_place) EXPECT_EQ(times, 12 / 3 * 2) << which.first;
}

TEST_F(StudyPlanTest, BetweenEachDoesOneAndMoreParticipantsChangeNothing) {
  const std::string begin = "name = \"tools\"\nseed = 3\ntrial = \"TRIAL.toml\"\nparticipants = ";
  const std::string end = "\n[[condition]]\nname = \"bare\"\n[[condition]]\nname = \"tongs\"\n";
  const std::vector<PlannedTrial> forty = PlannedTrials(ReadStudyPlan(Write(begin + "40" + end)));
  ASSERT_EQ(forty.size(), 40U);
  EXPECT_EQ(std::ranges::count(forty, "bare", &PlannedTrial::condition), 20);
  const std::vector<PlannedTrial> fifty = PlannedTrials(ReadStudyPlan(Write(begin + "50" + end)));
  for (std::size_t i = 0; i < forty.size(); ++i) EXPECT_EQ(fifty[i].condition, forty[i].condition) << i;
}

TEST_F(StudyPlanTest, AsAProgramItIsATable) {
  Write(kWithin);
  const auto run = Plan({"--json", "--out", (folder_ / "plan.csv").string()});
  ASSERT_EQ(run.exit_status, 0) << run.err;
  const auto json = nlohmann::json::parse(run.out);
  EXPECT_EQ(json["trials"].size(), 72U);
  EXPECT_EQ(json["conditions"][2]["participants"], 12);
  EXPECT_EQ(run.err, "");
  const std::string csv = test_support::ReadText(folder_ / "plan.csv");
  EXPECT_EQ(std::ranges::count(csv, '\n'), 1 + 72);
  EXPECT_TRUE(csv.starts_with("participant,order,condition,block,task,trial\nP01,1,")) << csv.substr(0, 200);
  const std::string text = Plan({}).out;
  EXPECT_EQ(std::ranges::count(text, '\n'), 12) << text;
}

TEST_F(StudyPlanTest, EachTrialGetsAFileThatNamesItsBase) {
  Write(kWithin);
  const auto run = Plan({"--json", "--trials", (folder_ / "trials").string()});
  ASSERT_EQ(run.exit_status, 0) << run.err;
  const auto json = nlohmann::json::parse(run.out);
  ASSERT_EQ(json["files"].size(), 72U);
  for (const auto& trial : json["trials"]) {
    const fs::path file = trial["file"].get<std::string>();
    EXPECT_EQ(file.filename(),
              fmt::format("{}-{}.toml", trial["participant"].get<std::string>(), trial["order"].get<int>()));
    const core::TrialInfo info = ReadTrialInfo(file);
    EXPECT_EQ(info.participant, trial["participant"]);
    EXPECT_EQ(info.condition, trial["condition"]);
    EXPECT_EQ(info.order, trial["order"]);
    EXPECT_EQ(info.block, trial["block"]);
    EXPECT_EQ(info.task, trial["task"]);
    EXPECT_NE(test_support::ReadText(file).find(trial["condition"] == "thick" ? "base = \"../THICK.toml\""
                                                                              : "base = \"../TRIAL.toml\""),
              std::string::npos);
  }
  const std::string first = json["files"][0];
  const std::string text = test_support::ReadText(first);
  EXPECT_EQ(Plan({"--trials", (folder_ / "trials").string()}).exit_status, 0) << "the same plan again";
  EXPECT_EQ(test_support::ReadText(first), text);
}

TEST_F(StudyPlanTest, NoFileThatSaysSomethingElseIsReplaced) {
  Write(kWithin);
  test_support::WriteText(folder_ / "P12-6.toml", "rig = \"mine.yml\"\n");
  const auto run = Plan({"--trials", folder_.path().string()});
  EXPECT_EQ(run.exit_status, 1);
  EXPECT_EQ(std::ranges::count(run.err, '\n'), 1) << run.err;
  EXPECT_NE(run.err.find("P12-6.toml: is there and says something else"), std::string::npos) << run.err;
  EXPECT_FALSE(fs::exists(folder_ / "P01-1.toml")) << "all or none";
  EXPECT_EQ(test_support::ReadText(folder_ / "P12-6.toml"), "rig = \"mine.yml\"\n");
}

TEST_F(StudyPlanTest, ItsOwnFilesAreNotReplacedByItsTable) {
  Write(kWithin);
  for (const char* name : {"STUDY.toml", "TRIAL.toml", "THICK.toml"}) {
    const std::string before = test_support::ReadText(folder_ / name);
    const auto run = Plan({"--out", (folder_ / name).string()});
    EXPECT_EQ(run.exit_status, 1) << name;
    EXPECT_NE(run.err.find(std::string(name) + ": the plan is made from this file"), std::string::npos)
        << run.err;
    EXPECT_EQ(test_support::ReadText(folder_ / name), before);
  }
}

TEST_F(StudyPlanTest, AnUnevenNumberIsSaid) {
  std::string text = kWithin;
  text.replace(text.find("12"), 2, "13");
  Write(text);
  const auto run = Plan({});
  EXPECT_EQ(run.exit_status, 0);
  EXPECT_NE(run.err.find("13 participants aren't a multiple of 6"), std::string::npos) << run.err;
  EXPECT_NE(run.err.find("12 or 18 would be even"), std::string::npos) << run.err;
  text.replace(text.find("13"), 2, "4");
  Write(text);
  EXPECT_NE(Plan({}).err.find("; 6 would be even"), std::string::npos);
}

TEST_F(StudyPlanTest, WhatIsWrongIsOneLineWithItsPlace) {
  const auto without = [](const std::string& line) {
    std::string text = kWithin;
    return text.erase(text.find(line), line.size() + 1);
  };
  const auto with = [](const std::string& was, const std::string& now) {
    std::string text = kWithin;
    return text.replace(text.find(was), was.size(), now);
  };
  for (const auto& [text, word] :
       {std::pair{without("seed = 7"), "seed"}, std::pair{with("seed = 7", "seed = -1"), "seed"},
        std::pair{without("name = \"gloves\""), "name"}, std::pair{with("\"within\"", "\"both\""), "between"},
        std::pair{with("participants = 12", "participants = []"), "participants"},
        std::pair{with("participants = 12", ""), "'participants' is missing"},
        std::pair{with("participants = 12", "participants = [\"../P\"]"), "can't be a participant's code"},
        std::pair{with("participants = 12", "participants = [\"=1+1\"]"), "can't be a participant's code"},
        std::pair{with("participants = 12", "participants = 0"), "1 to 10000"},
        std::pair{with("participants = 12", "participants = [\"A\", \"A\"]"), "there twice"},
        std::pair{with("\"thin\"", "\"bare\""), "earlier condition"},
        std::pair{with("THICK.toml", "THIN.toml"), "THIN.toml"},
        std::pair{without("trial = \"TRIAL.toml\""), "bare"},
        std::pair{with("design", "desing"), "design"}}) {
    Write(text);
    const auto run = Plan({"--out", (folder_ / "plan.csv").string()});
    EXPECT_EQ(run.exit_status, 1) << word;
    EXPECT_EQ(std::ranges::count(run.err, '\n'), 1) << run.err;
    EXPECT_NE(run.err.find("STUDY.toml"), std::string::npos) << run.err;
    EXPECT_NE(run.err.find(word), std::string::npos) << run.err;
    EXPECT_FALSE(fs::exists(folder_ / "plan.csv"));
  }
  EXPECT_THROW((void)ReadStudyPlan(folder_ / "nowhere.toml"), core::Error);
}

TEST(StudySample, IsThePlanOfTheNewcomersChapter) {
  const fs::path sample = test_support::SourceFolder() / "docs/examples/study/STUDY.toml";
  const std::vector<PlannedTrial> trials = PlannedTrials(ReadStudyPlan(sample));
  ASSERT_EQ(trials.size(), 12U);
  EXPECT_EQ(std::ranges::count(trials, "stiff cable", &PlannedTrial::condition), 6);
  const std::string chapter = test_support::ReadText(test_support::SourceFolder() / "docs/first_study.md");
  const std::string text = test_support::ReadText(sample);
  EXPECT_NE(chapter.find(text.substr(text.find("name"))), std::string::npos);
  EXPECT_NE(chapter.find(fmt::format("{}: 1. {}", trials[0].participant, trials[0].condition)),
            std::string::npos);
}

}  // namespace
}  // namespace elbowroom::control
