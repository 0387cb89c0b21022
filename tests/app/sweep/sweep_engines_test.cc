// GNU parallel and Slurm give the files that this process alone gives.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "tests/app/sweep/swept_sessions.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_file.h"

namespace elbowroom::tests {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

constexpr const char* kRange = "payload_a_gap=140:240:20";

bool IsInstalled(const char* program) {
  return std::system((std::string("command -v ") + program + " >/dev/null").c_str()) == 0;
}

class SweepEngines : public testing::Test {
 protected:
  void SetUp() override {
    fs::create_directory(folder_ / "it's a folder");
    for (const core::FrameIndex first : {20, 23, 26}) {
      sessions_.push_back(folder_ / "it's a folder" / ("s" + std::to_string(first) + ".db"));
      RecordTaskFrames(sessions_.back(), first);
    }
  }
  test_support::TemporaryFolder folder_;
  std::vector<fs::path> sessions_;
};

TEST_F(SweepEngines, GnuParallelGivesTheSameFiles) {
  if (!IsInstalled("parallel")) GTEST_SKIP() << "NOT TESTED: GNU parallel is not installed";
  const auto by_parallel =
      RunSweep(sessions_, kRange, folder_ / "parallel", {"--engine", "parallel", "--threads", "2", "--json"});
  ASSERT_EQ(by_parallel.exit_status, 0) << by_parallel.err;
  const auto json = nlohmann::json::parse(by_parallel.out);
  EXPECT_EQ(json["engine"], "parallel");
  EXPECT_EQ(json["cells"], 3);
  EXPECT_EQ(json["cells_from_before"], 0) << "its own cells aren't from before";
  const auto local = RunSweep(sessions_, kRange, folder_ / "local", {"--json"});
  ASSERT_EQ(local.exit_status, 0) << local.err;
  ExpectSameSweep(folder_ / "parallel", folder_ / "local");
}

TEST_F(SweepEngines, WhatAProcessComplainsOfIsTold) {
  if (!IsInstalled("parallel")) GTEST_SKIP() << "NOT TESTED: GNU parallel is not installed";
  test_support::RunOptions tiny;
  // The cells' folder can't be made, because a file is there.
  fs::create_directory(folder_ / "out");
  test_support::WriteText(folder_ / "out" / "cells", "");
  const auto run = RunSweep(sessions_, kRange, folder_ / "out", {"--engine", "parallel"});
  EXPECT_EQ(run.exit_status, 1);
  EXPECT_EQ(std::ranges::count(run.err, '\n'), 1) << run.err;
  EXPECT_THAT(run.err, HasSubstr("cells"));
}

TEST_F(SweepEngines, AMissingProgramIsNamedInOneLine) {
  test_support::RunOptions without;
  without.environment = {{"PATH", (folder_ / "nowhere").string()}};
  for (const auto& [engine, program, package] :
       {std::tuple{"parallel", "'parallel'", "package parallel"}, {"slurm", "'sbatch'", "slurm-client"}}) {
    const auto run = RunSweep(sessions_, kRange, folder_ / engine, {"--engine", engine}, without);
    EXPECT_EQ(run.exit_status, 1);
    EXPECT_EQ(std::ranges::count(run.err, '\n'), 1) << run.err;
    for (const char* word : {engine, program, package, "--engine local"})
      EXPECT_THAT(run.err, HasSubstr(word));
  }
}

// The script is run here as Slurm would, array task by array task.
TEST_F(SweepEngines, TheScriptForSlurmKeepsEveryCell) {
  test_support::RunOptions without;
  without.environment = {{"PATH", (folder_ / "nowhere").string()}};
  (void)RunSweep(sessions_, kRange, folder_ / "slurm", {"--engine", "slurm"}, without);
  const fs::path script = folder_ / "slurm" / "engine" / "sweep.sbatch";
  ASSERT_THAT(test_support::ReadText(script), HasSubstr("#SBATCH --array=1-3\n"));
  for (int task = 1; task <= 3; ++task) {
    test_support::RunOptions as_task;
    as_task.environment = {{"SLURM_ARRAY_TASK_ID", std::to_string(task)}};
    EXPECT_EQ(test_support::RunProgram("/bin/bash", {script.string()}, as_task).exit_status, 0);
    EXPECT_EQ(KeptCells(folder_ / "slurm"), static_cast<std::size_t>(task));
  }
  const auto gathered = RunSweep(sessions_, kRange, folder_ / "slurm", {"--json"});
  ASSERT_EQ(gathered.exit_status, 0) << gathered.err;
  EXPECT_EQ(nlohmann::json::parse(gathered.out)["cells_from_before"], 3);
  ASSERT_EQ(RunSweep(sessions_, kRange, folder_ / "local").exit_status, 0);
  ExpectSameSweep(folder_ / "slurm", folder_ / "local");
}

}  // namespace
}  // namespace elbowroom::tests
