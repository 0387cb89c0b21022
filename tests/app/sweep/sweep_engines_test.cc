// GNU parallel and Slurm give the files that this process alone gives.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>  // NOLINT: kill

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <map>
#include <thread>
#include <utility>

#include "app/control/sweep/engine_scripts.h"
#include "core/error.h"
#include "tests/app/sweep/killed_workers.h"
#include "tests/app/sweep/one_node_slurm.h"
#include "tests/app/sweep/swept_sessions.h"
#include "tests/support/places.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_file.h"

namespace elbowroom::tests {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

constexpr const char* kRange = "payload_a_gap=140:240:20";

// The sessions whose first process is killed as soon as it is seen.
std::map<fs::path, std::chrono::milliseconds> AtOnce(const std::vector<fs::path>& sessions) {
  std::map<fs::path, std::chrono::milliseconds> delays;
  for (const fs::path& session : sessions) delays[session] = {};
  return delays;
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
  if (!fs::exists("/usr/bin/parallel")) GTEST_SKIP() << "NOT TESTED: GNU parallel is not installed";
  const auto by_parallel =
      RunSweep(sessions_, kRange, folder_ / "parallel", {"--engine", "parallel", "--threads", "2", "--json"});
  ASSERT_EQ(by_parallel.exit_status, 0) << by_parallel.err;
  const auto json = nlohmann::json::parse(by_parallel.out);
  EXPECT_EQ(json["engine"], "parallel");
  EXPECT_EQ(json["cells"], 3 * 3) << "sessions, parts";
  EXPECT_EQ(json["cells_from_before"], 0) << "its own cells aren't from before";
  const auto local = RunSweep(sessions_, kRange, folder_ / "local", {"--json"});
  ASSERT_EQ(local.exit_status, 0) << local.err;
  ExpectSameSweep(folder_ / "parallel", folder_ / "local");
}

TEST_F(SweepEngines, ProcessesThatAreKilledLoseAndDoubleNothing) {
  if (!fs::exists("/usr/bin/parallel")) GTEST_SKIP() << "NOT TESTED: GNU parallel is not installed";
  const fs::path out = folder_ / "killed";
  FirstAttemptsKilled killer(out, AtOnce({sessions_[0], sessions_[2]}));
  const auto run = RunSweep(sessions_, kRange, out, {"--engine", "parallel", "--threads", "2", "--json"});
  const std::size_t kills = killer.Kills();
  ASSERT_EQ(run.exit_status, 0) << run.err;
  EXPECT_EQ(kills, 2U);
  EXPECT_THAT(run.err, HasSubstr(fmt::format("{} times a process was killed", kills)));
  ASSERT_EQ(RunSweep(sessions_, kRange, folder_ / "local").exit_status, 0);
  ExpectSameSweep(out, folder_ / "local");
  EXPECT_EQ(CellFiles(out), CellFiles(folder_ / "local"));
}

// One that is killed at each attempt, as by a machine without enough memory.
TEST_F(SweepEngines, AProcessThatIsKilledEachTimeEndsTheSweep) {
  if (!fs::exists("/usr/bin/parallel")) GTEST_SKIP() << "NOT TESTED: GNU parallel is not installed";
  const fs::path out = folder_ / "out";
  std::stop_source stop;
  std::jthread killer([&] {
    while (!stop.stop_requested()) KillEachWorker(out, sessions_[0]);
  });
  const auto run = RunSweep({sessions_[0]}, kRange, out, {"--engine", "parallel"});
  stop.request_stop();
  EXPECT_EQ(run.exit_status, 1) << run.out;
  EXPECT_EQ(std::ranges::count(run.err, '\n'), 1) << run.err;
  EXPECT_THAT(run.err, HasSubstr("was killed 3 times"));
  EXPECT_EQ(std::ranges::count(test_support::ReadText(out / "engine" / "killed"), '\n'), 3);
}

TEST_F(SweepEngines, ASlurmOfOneNodeGivesTheSameFiles) {
  std::string why_not;
  const auto slurm = OneNodeSlurm::Start(folder_ / "cluster", 2, &why_not);
  if (!slurm) GTEST_SKIP() << "NOT TESTED: " << why_not;
  test_support::RunOptions here;
  here.environment = slurm->Environment();
  const fs::path out = folder_ / "slurm";
  FirstAttemptsKilled killer(out, AtOnce({sessions_[1]}));
  const auto run = RunSweep(sessions_, kRange, out, {"--engine", "slurm", "--threads", "1", "--json"}, here);
  EXPECT_EQ(killer.Kills(), 1U);
  ASSERT_EQ(run.exit_status, 0) << run.err;
  EXPECT_EQ(nlohmann::json::parse(run.out)["cells_from_before"], 0) << "its own cells aren't from before";
  EXPECT_THAT(run.err, HasSubstr("1 times a process was killed"));
  ASSERT_EQ(RunSweep(sessions_, kRange, folder_ / "local").exit_status, 0);
  ExpectSameSweep(out, folder_ / "local");
  EXPECT_EQ(CellFiles(out), CellFiles(folder_ / "local"));
}

// Slurm takes no task of an array with a number from MaxArraySize on: two tasks take the five sessions in
// turn.
TEST_F(SweepEngines, ASlurmTakesMoreSessionsThanAnArrayHasTasks) {
  std::string why_not;
  const auto slurm = OneNodeSlurm::Start(folder_ / "cluster", 2, &why_not, 3);
  if (!slurm) GTEST_SKIP() << "NOT TESTED: " << why_not;
  for (const core::FrameIndex first : {29, 32}) {
    sessions_.push_back(folder_ / ("s" + std::to_string(first) + ".db"));
    RecordTaskFrames(sessions_.back(), first);
  }
  test_support::RunOptions here;
  here.environment = slurm->Environment();
  const fs::path out = folder_ / "slurm";
  FirstAttemptsKilled killer(out, AtOnce({sessions_[0], sessions_[4]}));  // both of the first task
  const auto run = RunSweep(sessions_, kRange, out, {"--engine", "slurm", "--threads", "1"}, here);
  EXPECT_EQ(killer.Kills(), 2U);
  ASSERT_EQ(run.exit_status, 0) << run.err;
  EXPECT_THAT(test_support::ReadText(out / "engine" / "sweep.sbatch"), HasSubstr("#SBATCH --array=1-2\n"));
  EXPECT_THAT(run.err, HasSubstr("2 times a process was killed"));
  ASSERT_EQ(RunSweep(sessions_, kRange, folder_ / "local").exit_status, 0);
  ExpectSameSweep(out, folder_ / "local");
  EXPECT_EQ(CellFiles(out), CellFiles(folder_ / "local"));
}

// The other sessions of its task are judged all the same, and kept.
TEST_F(SweepEngines, ASessionThatFailsEndsNoOtherOfItsTask) {
  const fs::path folder = folder_ / "engine";
  fs::create_directory(folder);
  test_support::WriteText(folder / "task", control::TaskScript(3));
  test_support::WriteText(folder / "commands",
                          "touch one\nfalse\ntouch three\nbash -c 'exit 7'\ntouch five\n");
  const auto run = [&](const std::vector<std::string>& which) {
    std::vector<std::string> arguments{(folder / "task").string()};
    arguments.insert(arguments.end(), which.begin(), which.end());
    return test_support::RunProgram("/bin/bash", arguments).exit_status;
  };
  EXPECT_EQ(run({"2", "2"}), 1) << "of the first that failed";
  EXPECT_EQ(run({"4"}), 7);
  EXPECT_EQ(run({"3"}), 0);
  EXPECT_TRUE(fs::exists(folder / "three"));
  EXPECT_FALSE(fs::exists(folder / "five"));
  EXPECT_EQ(run({"1", "2"}), 0);
  EXPECT_TRUE(fs::exists(folder / "one") && fs::exists(folder / "five"));
}

TEST(SlurmArray, HasNoMoreTasksThanTheClusterTakes) {
  using control::MostArrayTasks;
  EXPECT_EQ(MostArrayTasks(""), 1000);
  EXPECT_EQ(MostArrayTasks("MailProg = /bin/mail\nMaxArraySize            = 1001\nMaxJobCount = 10000\n"),
            1000);
  EXPECT_EQ(MostArrayTasks("MaxArraySize = 4000001"), 1000);
  EXPECT_EQ(MostArrayTasks("MaxArraySize = 51\nMaxJobCount = 10000"), 50);
  EXPECT_EQ(MostArrayTasks("MaxArraySize = 1001\nMaxJobCount = 20\n"), 20);
  EXPECT_EQ(MostArrayTasks("MaxArraySize =\nMaxArraySize = many\n"), 1000);
  for (const char* none : {"MaxArraySize = 0", "MaxArraySize = 1"})
    EXPECT_THROW((void)MostArrayTasks(none), core::Error) << none;
}

TEST_F(SweepEngines, WhatSbatchComplainsOfIsTold) {
  std::string why_not;
  const auto slurm = OneNodeSlurm::Start(folder_ / "cluster", 1, &why_not);
  if (!slurm) GTEST_SKIP() << "NOT TESTED: " << why_not;
  test_support::RunOptions here;
  here.environment = slurm->Environment();
  const auto run =
      RunSweep(sessions_, kRange, folder_ / "out", {"--engine", "slurm", "--threads", "64"}, here);
  EXPECT_EQ(run.exit_status, 1) << run.out;
  EXPECT_EQ(std::ranges::count(run.err, '\n'), 1) << run.err;
  EXPECT_THAT(run.err, HasSubstr("sbatch: error")) << "the node has one processor";
}

// Of more sessions than an array has tasks.
TEST_F(SweepEngines, EndedItTakesItsArrayOutOfSlurm) {
  std::string why_not;
  const auto slurm = OneNodeSlurm::Start(folder_ / "cluster", 1, &why_not, 3);
  if (!slurm) GTEST_SKIP() << "NOT TESTED: " << why_not;
  test_support::RunOptions ended;
  ended.environment = slurm->Environment();
  ended.while_running = [&](int process) {
    while (slurm->Queue().empty()) std::this_thread::sleep_for(std::chrono::milliseconds(20));
    ::kill(process, SIGINT);
  };
  const auto run =
      RunSweep(sessions_, kRange, folder_ / "out", {"--engine", "slurm", "--threads", "1"}, ended);
  EXPECT_EQ(run.exit_status, 1) << run.out;
  for (int wait = 0; wait < 100 && !slurm->Queue().empty(); ++wait)
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  EXPECT_EQ(slurm->Queue(), "");
}

TEST_F(SweepEngines, WhatAProcessComplainsOfIsTold) {
  if (!fs::exists("/usr/bin/parallel")) GTEST_SKIP() << "NOT TESTED: GNU parallel is not installed";
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
    EXPECT_EQ(CellFiles(folder_ / "slurm").size(), static_cast<std::size_t>(task));
  }
  const auto gathered = RunSweep(sessions_, kRange, folder_ / "slurm", {"--json"});
  ASSERT_EQ(gathered.exit_status, 0) << gathered.err;
  EXPECT_EQ(nlohmann::json::parse(gathered.out)["cells_from_before"], 3 * 3);
  ASSERT_EQ(RunSweep(sessions_, kRange, folder_ / "local").exit_status, 0);
  ExpectSameSweep(folder_ / "slurm", folder_ / "local");
}

}  // namespace
}  // namespace elbowroom::tests
