// What `simulate` refuses, what it prints, and that it goes on where it was.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/support/places.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_file.h"

namespace elbowroom {
namespace {

using test_support::ProgramRun;

class SimulateCommand : public testing::Test {
 protected:
  ProgramRun Simulate(const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"simulate", "--out", (folder_ / "out").string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return test_support::RunProgram(test_support::ProgramFile(), arguments);
  }
  test_support::TemporaryFolder folder_;
};

TEST_F(SimulateCommand, SaysWhatIsWrongInOneLineAndMakesNothing) {
  for (const std::vector<std::string>& wrong : {std::vector<std::string>{"paylaod"},
                                                {"--participants", "0"},
                                                {"--participants", "many"},
                                                {"--seed", "-1"},
                                                {"--seconds", "0"},
                                                {"--seconds", "nan"},
                                                {"--rate", "0.5"}}) {
    const ProgramRun run = Simulate(wrong);
    EXPECT_EQ(run.exit_status, 2) << wrong.back();
    EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
    EXPECT_TRUE(run.out.empty());
  }
  EXPECT_EQ(test_support::RunProgram(test_support::ProgramFile(), {"simulate"}).exit_status, 2) << "no --out";
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out"));
}

TEST_F(SimulateCommand, KeepsWhatIsThereAndRefusesAnothersSession) {
  const std::vector<std::string> options{"--participants", "2", "--seconds", "1", "--rate", "6", "--json"};
  const ProgramRun first = Simulate(options);
  ASSERT_EQ(first.exit_status, 0) << first.err;
  const auto told = nlohmann::json::parse(first.out);
  EXPECT_EQ(told["sessions"], 2);
  EXPECT_EQ(told["trials"][1]["participant"], "P02");
  EXPECT_EQ(told["files"].size(), 3U);
  const std::string truth = test_support::ReadText(folder_ / "out/truth.csv");
  EXPECT_EQ(std::count(truth.begin(), truth.end(), '\n'), 1 + 2);
  const auto again = nlohmann::json::parse(Simulate(options).out);
  EXPECT_EQ(again["sessions_from_before"], 2);
  EXPECT_EQ(again["trials"], told["trials"]);
  std::vector<std::string> other = options;
  other.insert(other.end(), {"--seed", "2"});
  const ProgramRun refused = Simulate(other);
  EXPECT_EQ(refused.exit_status, 1);
  EXPECT_EQ(std::count(refused.err.begin(), refused.err.end(), '\n'), 1) << refused.err;
  EXPECT_NE(refused.err.find("P01.db' is there already"), std::string::npos) << refused.err;
  EXPECT_EQ(test_support::ReadText(folder_ / "out/truth.csv"), truth);
}

}  // namespace
}  // namespace elbowroom
