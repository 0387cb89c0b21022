// The spacing swept as a user does it, over a few recorded frames of the demo.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/app/sweep/swept_sessions.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_file.h"

namespace elbowroom {
namespace {

using test_support::ProgramRun;

class SweepCommand : public testing::Test {
 protected:
  [[nodiscard]] ProgramRun Sweep(const std::string& spacing,
                                 const std::vector<std::string>& more = {}) const {
    return tests::RunSweep({folder_ / "s.db"}, spacing, folder_ / "out", more);
  }
  test_support::TemporaryFolder folder_;
};

TEST_F(SweepCommand, FindsTheSpaceThatTheTaskNeeds) {
  const int touched = tests::RecordTaskFrames(folder_ / "s.db");
  ASSERT_GT(touched, 0);
  const ProgramRun run = Sweep("payload_a_gap=140:240:50", {"--json"});
  ASSERT_EQ(run.exit_status, 0) << run.err;
  const auto json = nlohmann::json::parse(run.out);
  EXPECT_EQ(json["moved"], nlohmann::json::array({"payload_a"}));
  ASSERT_EQ(json["steps"].size(), 3U);
  EXPECT_EQ(json["steps"][0]["parts"][1]["frames_in_contact"], touched) << "as recorded";
  EXPECT_EQ(json["steps"][2]["parts"][1]["frames_in_contact"], 0);
  EXPECT_GT(json["steps"][2]["parts"][1]["lower_mm"].get<double>(), 0.0);
  const double touched_mm = json["largest_touched_mm"], free_mm = json["smallest_free_mm"];
  EXPECT_LT(touched_mm, free_mm);
  EXPECT_LE(free_mm, 240.0);
  EXPECT_GE(touched_mm, 140.0);
  EXPECT_EQ(json["unmoved"], 6 * 2 * 2) << "frames, parts, steps but one";
  const std::string csv = test_support::ReadText(folder_ / "out/sweep.csv");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1 + 3 * 3);
  EXPECT_NE(csv.find("\n140,payload_a,1," + std::to_string(touched) + ","), std::string::npos) << csv;
  EXPECT_TRUE(test_support::ReadText(folder_ / "out/sweep.svg").starts_with("<svg"));
  EXPECT_TRUE(test_support::ReadText(folder_ / "out/sweep.png").starts_with("\x89PNG"));
}

TEST_F(SweepCommand, SaysWhatIsWrongInOneLineAndLeavesNothing) {
  tests::RecordTaskFrames(folder_ / "s.db");
  for (const auto& [spacing, word] : {std::pair{"payload_gap=140:240:50", "did you mean 'payload_a_gap'"},
                                      std::pair{"payload_a_gap=10:240:50", "from 60 to 400"}}) {
    const ProgramRun run = Sweep(spacing);
    EXPECT_EQ(run.exit_status, 1);
    EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
    EXPECT_NE(run.err.find(word), std::string::npos) << run.err;
  }
  for (const char* usage : {"payload_a_gap=140", "payload_a_gap=240:140:10", "=1:2:3", "payload_a_gap=1:2:0"})
    EXPECT_EQ(Sweep(usage).exit_status, 2) << usage;
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out"));
}

TEST_F(SweepCommand, ToldOfSeveralSessionsIsEachAndAllTogether) {
  std::vector<std::filesystem::path> sessions;
  for (const core::FrameIndex first : {20, 24}) {
    sessions.push_back(folder_ / ("s" + std::to_string(first) + ".db"));
    tests::RecordTaskFrames(sessions.back(), first, "=cmd|' /C calc'!A0");
  }
  const auto json_of = [&](const std::vector<std::filesystem::path>& which, const std::string& out) {
    const ProgramRun run = tests::RunSweep(which, "payload_a_gap=140:240:20", folder_ / out, {"--json"});
    EXPECT_EQ(run.exit_status, 0) << run.err;
    return nlohmann::json::parse(run.out);
  };
  const auto both = json_of(sessions, "both"), a = json_of({sessions[0]}, "a"),
             b = json_of({sessions[1]}, "b");
  ASSERT_EQ(both["sessions"].size(), 2U);
  EXPECT_EQ(both["frames"], 12);
  for (std::size_t i = 0; i < 2; ++i) {
    const auto& alone = i == 0 ? a : b;
    EXPECT_EQ(both["sessions"][i]["steps"], alone["steps"]);
    EXPECT_EQ(both["sessions"][i]["smallest_free_mm"], alone["smallest_free_mm"]);
    EXPECT_EQ(both["sessions"][i]["tools"], alone["tools"]);
    EXPECT_EQ(both["sessions"][i]["session"], sessions[i].string());
  }
  const auto larger = [&](const char* key) { return std::max(a[key].get<double>(), b[key].get<double>()); };
  EXPECT_EQ(both["all"]["smallest_free_mm"], larger("smallest_free_mm"));
  EXPECT_EQ(both["all"]["smallest_with_clearance_mm"], larger("smallest_with_clearance_mm"));
  EXPECT_EQ(both["smallest_free_mm"], both["all"]["smallest_free_mm"]);
  for (std::size_t step = 0; step < 6; ++step) {
    const auto &all = both["all"]["steps"][step]["parts"][1], &x = a["steps"][step]["parts"][1],
               &y = b["steps"][step]["parts"][1];
    EXPECT_EQ(all["frames_in_contact"],
              x["frames_in_contact"].get<int>() + y["frames_in_contact"].get<int>());
    EXPECT_EQ(all["deepest_mm"], std::max(x["deepest_mm"].get<double>(), y["deepest_mm"].get<double>()));
    EXPECT_EQ(all["lower_mm"], std::min(x["lower_mm"].get<double>(), y["lower_mm"].get<double>()));
    EXPECT_TRUE(all["closest_frame"].is_null()) << "of which session?";
  }
  const std::string csv = test_support::ReadText(folder_ / "both/sweep.csv");
  EXPECT_TRUE(csv.starts_with("session,spacing_mm,part,"));
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1 + 2 * 6 * 3);
}

TEST_F(SweepCommand, ASessionThatChangedIsAskedAgain) {
  tests::RecordTaskFrames(folder_ / "s.db", 20);
  ASSERT_EQ(Sweep("payload_a_gap=140:240:50").exit_status, 0);
  std::filesystem::remove(folder_ / "s.db");
  tests::RecordTaskFrames(folder_ / "s.db", 22);
  const ProgramRun run = Sweep("payload_a_gap=140:240:50", {"--json"});
  ASSERT_EQ(run.exit_status, 0) << run.err;
  EXPECT_EQ(nlohmann::json::parse(run.out)["cells_from_before"], 0);
}

TEST_F(SweepCommand, RefusesSessionsThatDontGoTogether) {
  tests::RecordTaskFrames(folder_ / "s.db", 20);
  std::filesystem::copy_file(folder_ / "s.db", folder_ / "copy.db");
  const ProgramRun run =
      tests::RunSweep({folder_ / "s.db", folder_ / "copy.db"}, "payload_a_gap=140:240:50", folder_ / "out");
  EXPECT_EQ(run.exit_status, 1);
  EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
  EXPECT_THAT(run.err, ::testing::HasSubstr("one recording"));
  const ProgramRun missing = tests::RunSweep({folder_ / "s.db", folder_ / "nothing.db"},
                                             "payload_a_gap=140:240:50", folder_ / "out");
  EXPECT_EQ(missing.exit_status, 1);
  EXPECT_THAT(missing.err, ::testing::HasSubstr("nothing.db"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out"));
}

}  // namespace
}  // namespace elbowroom
