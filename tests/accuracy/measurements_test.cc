#include "tests/accuracy/measurements.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/accuracy/callgrind.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_file.h"

namespace elbowroom::accuracy {
namespace {

using test_support::ReadText;
using test_support::WriteText;

TEST(WriteMicroTable, TellsWhatGoogleBenchmarkMeasured) {
  const test_support::TemporaryFolder folder;
  WriteText(folder / "performance.md",
            "before\n<!-- bench:micro begin -->\n<!-- bench:micro end -->\nafter\n");
  WriteText(folder / "run.json",
            R"({"benchmarks": [
              {"run_name": "Project", "run_type": "iteration", "repetitions": 3, "real_time": 9.0, "time_unit": "us"},
              {"run_name": "Project", "run_type": "aggregate", "aggregate_name": "median", "repetitions": 3,
               "real_time": 12.5, "time_unit": "us", "items_per_second": 8e7, "differing": NaN},
              {"run_name": "View", "run_type": "iteration", "real_time": 3.21, "time_unit": "ms"}]})");
  WriteMicroTable(folder.path(), folder / "run.json");
  const std::string text = ReadText(folder / "performance.md");
  EXPECT_NE(text.find("| Project | 12.5 us | 12.5 ns |\n| View | 3.21 ms | - |\n"), std::string::npos)
      << text;
  EXPECT_TRUE(text.starts_with("before\n"));
  EXPECT_TRUE(text.ends_with("\nafter\n"));
  EXPECT_THROW(WriteMicroTable(folder.path(), folder / "performance.md"), core::Error);
}

TEST(CountInstructions, FollowsTheHullOnScreen) {
  const auto count = [](const std::vector<std::string>& arguments) {
    return CountInstructions(ELBOWROOM_VIEW_COST, arguments, "*CountedView*");
  };
  const CallgrindCount small = count({"--zoom", "0.25"}), larger = count({"--zoom", "0.5"});
  EXPECT_GT(std::stoi(larger.output), 3 * std::stoi(small.output));
  constexpr std::int64_t kAtLeast = 100'000;  // were it less, nothing was counted
  EXPECT_GT(small.instructions, kAtLeast);
  EXPECT_GT(larger.instructions, small.instructions);
}

TEST(CountInstructions, SaysInOneLineWhatToInstall) {
  try {
    (void)CountInstructions("/bin/true", {}, "main", "valgrind-that-is-not-there");
    FAIL();
  } catch (const core::Error& error) {
    EXPECT_STREQ(
        error.what(),
        "'valgrind-that-is-not-there' isn't installed, so nothing is counted; install the package valgrind");
  }
}

}  // namespace
}  // namespace elbowroom::accuracy
