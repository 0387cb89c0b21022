// elbowroom replay as a user runs it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/control/demo_trial.h"
#include "app/control/trial_runner.h"
#include "tests/support/places.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"

namespace elbowroom {
namespace {

using test_support::ProgramRun;
using ::testing::HasSubstr;

class ReplayCommand : public testing::Test {
 protected:
  void SetUp() override {
    control::TrialOptions options;
    options.session = folder_ / "s.db";
    options.frames = {60, 80};
    control::TrialControls controls;
    (void)control::RunTrial(control::MakeDemoTrial(control::DemoPlay::kOnce), options, controls, {});
  }
  [[nodiscard]] ProgramRun Replay(const std::vector<std::string>& more) const {
    std::vector<std::string> arguments{"replay", (folder_ / "s.db").string(), "--session",
                                       (folder_ / "new.db").string(), "--json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return test_support::RunProgram(test_support::ProgramFile(), arguments);
  }
  [[nodiscard]] bool HasNew() const { return std::filesystem::exists(folder_ / "new.db"); }
  test_support::TemporaryFolder folder_;
};

TEST_F(ReplayCommand, SaysThatItIsIdentical) {
  const ProgramRun run = Replay({});
  ASSERT_EQ(run.exit_status, 0) << run.err;
  const auto json = nlohmann::json::parse(run.out);
  EXPECT_EQ(json["frames"], 20);
  EXPECT_EQ(json["identical"], true);
  EXPECT_GT(json["contact_rows"], 0);
  EXPECT_GT(json["touches"], 0);
  EXPECT_GT(json["time_ms"], 0.0);
  EXPECT_TRUE(json["changes"].empty());
}

TEST_F(ReplayCommand, SaysWhatWasChanged) {
  const std::string gap = control::MakeDemoTrial(control::DemoPlay::kOnce).layout.spacings[0].name;
  const ProgramRun run = Replay({"--spacing", gap + "=240"});
  ASSERT_EQ(run.exit_status, 0) << run.err;
  const auto json = nlohmann::json::parse(run.out);
  EXPECT_TRUE(json["identical"].is_null());
  ASSERT_EQ(json["changes"].size(), 1U);
  EXPECT_THAT(json["changes"][0].get<std::string>(), HasSubstr("240 mm in all frames"));
  EXPECT_EQ(json["contact_rows"], 0);
}

TEST_F(ReplayCommand, RefusesInOneLineAndWritesNothing) {
  for (const auto& [arguments, told] :
       {std::pair{std::vector<std::string>{"--frames", "500:600"}, "frames 60 to 79"},
        std::pair{std::vector<std::string>{"--spacing", "nothing=3"}, "no spacing"},
        std::pair{std::vector<std::string>{"--part", "PMT=missing.stl"}, "missing.stl"},
        std::pair{std::vector<std::string>{"--layout", "missing.toml"}, "missing.toml"}}) {
    const ProgramRun run = Replay(arguments);
    EXPECT_EQ(run.exit_status, 1);
    EXPECT_THAT(run.err, HasSubstr(told));
    EXPECT_EQ(std::ranges::count(run.err, '\n'), 1);
    EXPECT_FALSE(HasNew());
  }
  EXPECT_EQ(Replay({"--part", "PMT"}).exit_status, 2);
}

}  // namespace
}  // namespace elbowroom
