// elbowroom bench as a user runs it.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/support/places.h"
#include "tests/support/run_program.h"

namespace elbowroom {
namespace {

using test_support::ProgramRun;
using test_support::RunProgram;

TEST(CliBench, TimesWhatItIsAskedFor) {
  const ProgramRun run =
      RunProgram(test_support::ProgramFile(), {"--json", "--threads", "1", "bench", "segmentation"});
  ASSERT_EQ(run.exit_status, 0) << run.err;
  const nlohmann::json result = nlohmann::json::parse(run.out);
  EXPECT_EQ(result.at("threads"), 1);
  ASSERT_EQ(result.at("benchmarks").size(), 2U);
  const nlohmann::json& timing = result["benchmarks"][0];
  EXPECT_EQ(timing.at("name"), "segmentation");
  EXPECT_GE(timing.at("repetitions"), 31);
  EXPECT_GT(timing.at("fastest_ms"), 0.0);
  EXPECT_GE(timing.at("time_ms"), timing.at("fastest_ms"));
}

TEST(CliBench, SaysWhatThereIsForAnUnknownName) {
  const ProgramRun run = RunProgram(test_support::ProgramFile(), {"bench", "levitation"});
  EXPECT_EQ(run.exit_status, 1);
  EXPECT_EQ(run.out, "");
  EXPECT_EQ(run.err, "elbowroom: there is no benchmark 'levitation'; there are: view, segmentation, hull\n");
}

TEST(CliBench, SelfTestFindsThatOpenGlComputesWhatTheProcessorDoes) {
  const ProgramRun run = RunProgram(test_support::ProgramFile(), {"--json", "bench", "selftest"});
  ASSERT_EQ(run.exit_status, 0) << run.err;
  const nlohmann::json result = nlohmann::json::parse(run.out);
  EXPECT_EQ(result.at("passed"), true);
  EXPECT_NE(result.at("driver"), "");
  ASSERT_GE(result.at("tests").size(), 2U);
  for (const nlohmann::json& test : result["tests"]) {
    EXPECT_GT(test.at("hit_pixels"), 1000) << test;
    EXPECT_EQ(test.at("unexplained_pixels"), 0) << test;
  }
}

TEST(CliBench, HelpListsTheBenchmarks) {
  const ProgramRun run = RunProgram(test_support::ProgramFile(), {"bench", "--help"});
  EXPECT_EQ(run.exit_status, 0);
  for (const char* name : {"view", "segmentation", "hull", "selftest"})
    EXPECT_NE(run.out.find(std::string("\n  ") + name + " "), std::string::npos) << run.out;
}

}  // namespace
}  // namespace elbowroom
