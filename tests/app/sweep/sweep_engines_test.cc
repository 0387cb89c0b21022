// GNU parallel and Slurm give the files that this process alone gives.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>  // NOLINT: kill

#include <algorithm>
#include <cctype>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <thread>
#include <utility>

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
  EXPECT_EQ(json["cells"], 3 * 3) << "sessions, parts";
  EXPECT_EQ(json["cells_from_before"], 0) << "its own cells aren't from before";
  const auto local = RunSweep(sessions_, kRange, folder_ / "local", {"--json"});
  ASSERT_EQ(local.exit_status, 0) << local.err;
  ExpectSameSweep(folder_ / "parallel", folder_ / "local");
}

// A process's arguments, with a space between.
std::string CommandOf(const fs::path& process) {
  std::ifstream file(process / "cmdline");
  std::string command(100'000, '\0');
  file.read(command.data(), std::ssize(command));  // a process that has just ended gives nothing
  command.resize(static_cast<std::size_t>(file.gcount()));
  std::ranges::replace(command, '\0', ' ');
  return command;
}

// Kills the processes that keep cells of these sessions in `out`. `once`: those that were killed, which
// aren't again; null: each is, whenever it is seen.
void KillProcessesOf(const fs::path& out, const std::vector<fs::path>& sessions, std::set<fs::path>* once) {
  for (const auto& entry : fs::directory_iterator("/proc")) {
    const std::string name = entry.path().filename().string();
    if (!std::ranges::all_of(name, [](unsigned char c) { return std::isdigit(c) != 0; })) continue;
    const std::string command = CommandOf(entry.path());
    if (!command.starts_with(test_support::ProgramFile().string()) ||
        command.find("--cells-only") == std::string::npos || command.find(out.string()) == std::string::npos)
      continue;
    for (const fs::path& session : sessions) {
      if (command.find(session.string()) == std::string::npos || (once != nullptr && once->contains(session)))
        continue;
      if (::kill(std::stoi(name), SIGKILL) == 0 && once != nullptr) once->insert(session);
    }
  }
}

// While it lives, the first process of each of these sessions is killed.
class FirstAttemptsKilled {
 public:
  FirstAttemptsKilled(fs::path out, std::vector<fs::path> sessions)
      : thread_([this, out = std::move(out), sessions = std::move(sessions)](const std::stop_token& stop) {
          while (!stop.stop_requested()) KillProcessesOf(out, sessions, &killed_);
        }) {}
  [[nodiscard]] std::size_t Kills() {
    thread_.request_stop();
    thread_.join();
    return killed_.size();
  }

 private:
  std::set<fs::path> killed_;
  std::jthread thread_;
};

TEST_F(SweepEngines, ProcessesThatAreKilledLoseAndDoubleNothing) {
  if (!IsInstalled("parallel")) GTEST_SKIP() << "NOT TESTED: GNU parallel is not installed";
  const fs::path out = folder_ / "killed";
  FirstAttemptsKilled killer(out, {sessions_[0], sessions_[2]});
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
  if (!IsInstalled("parallel")) GTEST_SKIP() << "NOT TESTED: GNU parallel is not installed";
  const fs::path out = folder_ / "out";
  std::stop_source stop;
  std::jthread killer([&] {
    while (!stop.stop_requested()) KillProcessesOf(out, {sessions_[0]}, nullptr);
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
  FirstAttemptsKilled killer(out, {sessions_[1]});
  const auto run = RunSweep(sessions_, kRange, out, {"--engine", "slurm", "--threads", "1", "--json"}, here);
  EXPECT_EQ(killer.Kills(), 1U);
  ASSERT_EQ(run.exit_status, 0) << run.err;
  EXPECT_EQ(nlohmann::json::parse(run.out)["cells_from_before"], 0) << "its own cells aren't from before";
  EXPECT_THAT(run.err, HasSubstr("1 times a process was killed"));
  ASSERT_EQ(RunSweep(sessions_, kRange, folder_ / "local").exit_status, 0);
  ExpectSameSweep(out, folder_ / "local");
  EXPECT_EQ(CellFiles(out), CellFiles(folder_ / "local"));
}

TEST_F(SweepEngines, EndedItTakesItsArrayOutOfSlurm) {
  std::string why_not;
  const auto slurm = OneNodeSlurm::Start(folder_ / "cluster", 1, &why_not);
  if (!slurm) GTEST_SKIP() << "NOT TESTED: " << why_not;
  test_support::RunOptions ended;
  ended.environment = slurm->Environment();
  ended.while_running = [&](int process) {
    while (slurm->Queue().empty()) std::this_thread::sleep_for(std::chrono::milliseconds(20));
    ::kill(process, SIGINT);
  };
  const auto run = RunSweep(sessions_, kRange, folder_ / "out", {"--engine", "slurm"}, ended);
  EXPECT_EQ(run.exit_status, 1) << run.out;
  for (int wait = 0; wait < 100 && !slurm->Queue().empty(); ++wait)
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  EXPECT_EQ(slurm->Queue(), "");
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
