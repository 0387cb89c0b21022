// What `study` refuses, and what it says where something is missing.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/app/study/cohort.h"
#include "tests/support/places.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_file.h"

namespace elbowroom {
namespace {

using test_support::ProgramRun;

class StudyCommand : public testing::Test {
 protected:
  ProgramRun Study(const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"study", (folder_ / "s.db").string(), "--out",
                                       (folder_ / "out").string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return test_support::RunProgram(test_support::ProgramFile(), arguments);
  }
  test_support::TemporaryFolder folder_;
};

TEST_F(StudyCommand, SaysWhatIsWrongInOneLineAndLeavesNothing) {
  EXPECT_EQ(Study({}).exit_status, 1) << "no such session";
  tests::RecordReach(folder_ / "s.db", {"P1", "bare", 1, 100.0, 0.0, 80.0});
  for (const auto& [spacing, word] :
       {std::pair{"lid_gpa", "did you mean 'lid_gap'"}, std::pair{"width", "there is 'lid_gap'"},
        std::pair{"lid_gap=0:200:10", "from 20 to 300"}}) {
    const ProgramRun run = Study({"--spacing", spacing});
    EXPECT_EQ(run.exit_status, 1);
    EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
    EXPECT_NE(run.err.find(word), std::string::npos) << run.err;
  }
  const ProgramRun baseline = Study({"--baseline", "bar"});
  EXPECT_EQ(baseline.exit_status, 1);
  EXPECT_EQ(std::count(baseline.err.begin(), baseline.err.end(), '\n'), 1) << baseline.err;
  EXPECT_NE(baseline.err.find("no session has the condition 'bar'; did you mean 'bare'?"), std::string::npos)
      << baseline.err;
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out/participants.csv"));
}

TEST_F(StudyCommand, WhatIsNotKnownIsMissingAndSaid) {
  tests::RecordReach(folder_ / "s.db", {"", "", 0, 0.0, 0.0, 80.0});
  const ProgramRun run = Study({"--json", "--spacing", "lid_gap=20:60:10"});
  ASSERT_EQ(run.exit_status, 0) << run.err;
  const auto study = nlohmann::json::parse(run.out);
  ASSERT_EQ(study["rows"].size(), 1U);
  for (const char* key : {"estimate_before_mm", "needed_mm", "shortfall_mm", "estimate_after_mm"})
    EXPECT_TRUE(study["rows"][0][key].is_null()) << key;
  EXPECT_EQ(study["rows"][0]["participant"], "s");
  EXPECT_TRUE(study["mean_shortfall_mm"].is_null());
  EXPECT_TRUE(study["comparisons"].empty());
  std::string notes;
  for (const auto& note : study["notes"]) notes += note.get<std::string>() + "\n";
  for (const char* word : {"name no participant", "touched at the largest gap tried, 60 mm",
                           "gave no estimate before", "gave no estimate after"})
    EXPECT_NE(notes.find(word), std::string::npos) << word << " in\n" << notes;
}

// What was free at the smallest gap tried may need less, where the layout has smaller gaps.
TEST_F(StudyCommand, WhatIsFreeAtTheSmallestGapTriedIsNotKnown) {
  tests::RecordReach(folder_ / "s.db", {"P1", "", 1, 100.0, 0.0, 80.0});
  tests::RecordReach(folder_ / "higher.db", {"P2", "", 1, 100.0, 0.0, 80.0});
  tests::RecordReach(folder_ / "highest.db", {"P2", "", 2, 100.0, 0.0, 150.0});
  const std::string higher = (folder_ / "higher.db").string(), highest = (folder_ / "highest.db").string();
  const auto study_from = [&](const char* range) {
    const ProgramRun run = Study({higher, highest, "--json", "--spacing", range});
    EXPECT_EQ(run.exit_status, 0) << run.err;
    return nlohmann::json::parse(run.out);
  };
  const auto above = study_from("lid_gap=120:200:10"), all = study_from("lid_gap=20:200:10");
  EXPECT_TRUE(above["rows"][0]["needed_mm"].is_null()) << above.dump();
  EXPECT_TRUE(above["rows"][0]["needed_without_tools_mm"].is_null());
  EXPECT_TRUE(above["rows"][0]["shortfall_mm"].is_null());
  EXPECT_LT(all["rows"][0]["needed_mm"], 100.0);
  for (const char* key : {"needed_mm", "needed_without_tools_mm"})
    EXPECT_EQ(above["rows"][1][key], all["rows"][1][key]) << "the larger of both sessions is known";
  EXPECT_EQ(above["mean_shortfall_mm"], above["rows"][1]["shortfall_mm"]);
  std::size_t notes = 0;
  for (const auto& note : above["notes"])
    notes += note.get<std::string>().find("free at the smallest gap tried, 120 mm") != std::string::npos;
  EXPECT_EQ(notes, 2U) << above["notes"].dump();
  for (const auto& note : all["notes"])
    EXPECT_EQ(note.get<std::string>().find("smallest gap"), std::string::npos) << note;
}

TEST_F(StudyCommand, FewInAConditionIsSaidOfManyParticipants) {
  std::vector<std::string> more{"--json", "--spacing", "lid_gap=60:120:30"};
  for (int i = 0; i < 12; ++i) {
    const auto file = i == 0 ? folder_ / "s.db" : folder_ / fmt::format("s{}.db", i);
    tests::RecordReach(file, {.participant = fmt::format("P{}", i),
                              .condition = i < 10 ? "bare" : "gloves",
                              .estimate_before_mm = 80.0 + i});
    if (i > 0) more.push_back(file.string());
  }
  const ProgramRun run = Study(more);
  ASSERT_EQ(run.exit_status, 0) << run.err;
  const auto study = nlohmann::json::parse(run.out);
  EXPECT_NE(study["notes"].dump().find("few participants in a condition, 'gloves' 2: "), std::string::npos)
      << study["notes"].dump();
  EXPECT_EQ(study["notes"].dump().find("'bare' 10"), std::string::npos);
}

TEST_F(StudyCommand, ToldInWordsIsATable) {
  tests::RecordReach(folder_ / "s.db", {"P1", "bare", 1, 100.0, 120.0, 80.0});
  const ProgramRun run = Study({});
  ASSERT_EQ(run.exit_status, 0) << run.err;
  for (const char* word :
       {"'lid_gap', mm: 1 participant, 1 session", "needed without", "mean shortfall -", "note: "})
    EXPECT_NE(run.out.find(word), std::string::npos) << word << " in\n" << run.out;
}

TEST_F(StudyCommand, ABlockIsStudiedAlone) {
  tests::RecordReach(folder_ / "s.db",
                     {.participant = "P1", .condition = "", .estimate_before_mm = 100.0, .block = "timed"});
  tests::RecordReach(folder_ / "t.db",
                     {.participant = "P1", .condition = "", .estimate_before_mm = 90.0, .block = "practice"});
  const std::string other = (folder_ / "t.db").string();
  const ProgramRun run = Study({other, "--json", "--block", "timed", "--spacing", "lid_gap=60:120:30"});
  ASSERT_EQ(run.exit_status, 0) << run.err;
  const auto study = nlohmann::json::parse(run.out);
  EXPECT_EQ(study["sessions"], 1);
  EXPECT_EQ(study["block"], "timed");
  EXPECT_EQ(study["rows"][0]["estimate_before_mm"], 100.0);
  EXPECT_EQ(study["notes"][0],
            "1 of 2 sessions are of another block than 'timed', or of none: they are left out");
  const ProgramRun wrong = Study({other, "--block", "tiemd"});
  EXPECT_EQ(wrong.exit_status, 1);
  EXPECT_NE(wrong.err.find("no session is of block 'tiemd'; choose one that there is: 'practice', 'timed'"),
            std::string::npos)
      << wrong.err;
}

// Two by two in two conditions, so that there is a test.
TEST_F(StudyCommand, ScoresAreMeasures) {
  std::vector<std::string> more{"--json", "--spacing", "lid_gap=60:120:30"};
  for (int i = 0; i < 4; ++i) {
    const std::string name = i == 0 ? "s" : "s" + std::to_string(i);
    tests::RecordReach(folder_ / (name + ".db"), {.participant = "P" + std::to_string(i),
                                                  .condition = i < 2 ? "bare" : "gloves",
                                                  .hand_mm = 60.0 + 5.0 * i,
                                                  .sickness = i});
    if (i > 0) more.push_back((folder_ / (name + ".db")).string());
  }
  const ProgramRun run = Study(more);
  ASSERT_EQ(run.exit_status, 0) << run.err;
  const auto study = nlohmann::json::parse(run.out);
  const auto of_score = [](const nlohmann::json& entry, const char* key) {
    return entry[key] == "score:sickness:total";
  };
  const auto& comparisons = study["comparisons"];
  const auto& correlations = study["correlations"];
  const auto compared = std::find_if(comparisons.begin(), comparisons.end(),
                                     [&](const nlohmann::json& entry) { return of_score(entry, "measure"); });
  ASSERT_TRUE(compared != comparisons.end());
  EXPECT_DOUBLE_EQ((*compared)["mean_a"].get<double>(), 9.54 * 0.5);
  EXPECT_DOUBLE_EQ((*compared)["mean_b"].get<double>(), 9.54 * 2.5);
  EXPECT_TRUE(std::any_of(correlations.begin(), correlations.end(),
                          [&](const nlohmann::json& entry) { return of_score(entry, "a"); }));
  const std::string csv = test_support::ReadText(folder_ / "out/sessions.csv");
  EXPECT_NE(csv.find("score:sickness:total"), std::string::npos) << csv.substr(0, 300);
  EXPECT_NE(test_support::ReadText(folder_ / "out/report.html").find("sickness:total"), std::string::npos);
}

}  // namespace
}  // namespace elbowroom
