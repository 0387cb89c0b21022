// Trials whose session file can't be written for a while, or no longer: full disks, locks, files and folders
// that go, disks that turn read-only or lose their power.
#include <SQLiteCpp/SQLiteCpp.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <functional>
#include <iostream>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "sessions/session_reader.h"
#include "tests/adversary/disk_mount.h"
#include "tests/adversary/recorded_session.h"
#include "tests/adversary/sample_trial_files.h"
#include "tests/support/places.h"
#include "tests/support/soak.h"
#include "tests/support/temporary_folder.h"

namespace elbowroom::adversary {
namespace {

namespace fs = std::filesystem;
using std::chrono::milliseconds;
using test_support::ProgramRun;
using test_support::TemporaryFolder;

// A session on a medium that can't be written, as a crash left it: with a log and without the log's index.
TEST(CutOffSession, OpensOnAReadOnlyMedium) {
  const TemporaryFolder folder;
  const fs::path session = folder / "disk" / "session.db";
  const auto disk = DiskMount::InMemory(folder / "disk", 64);
  if (!disk) GTEST_SKIP() << "NOT TESTED: no file system may be mounted here";
  std::int64_t frames_before = 0;
  test_support::RunOptions options = AsInATest();
  options.while_running = [&](int process) {
    frames_before = WaitForFrames(session, 100, process);
    kill(process, SIGKILL);
  };
  (void)test_support::RunProgram(test_support::ProgramFile(),
                                 {"trial", "run", WriteMaskTrial(folder / "files", 1000).string(),
                                  "--headless", "--session", session.string()},
                                 options);
  ASSERT_TRUE(fs::exists(session.string() + "-wal"));
  fs::remove(session.string() + "-shm");
  ASSERT_TRUE(disk->RemountReadOnly());
  const ProgramRun report = test_support::RunProgram(
      test_support::ProgramFile(), {"report", session.string(), "--out", (folder / "report").string()},
      AsInATest());
  EXPECT_EQ(report.exit_status, 0) << report.err;
  EXPECT_GE(sessions::SessionReader(session).frame_count(), frames_before);
  EXPECT_EQ(sessions::SessionReader(session).status(), sessions::SessionStatus::kCutOff);
}

// What records into `session`; the files that it takes are in `files`.
struct TrialKind {
  const char* name;
  bool is_live = false;  // it goes on until it is stopped
  std::function<std::vector<std::string>(const fs::path& files, const fs::path& session)> words;
};

const TrialKind kDemo = {"demo", false, [](const fs::path& /*files*/, const fs::path& session) {
                           return std::vector<std::string>{"--json", "demo", "--headless", "--out",
                                                           session.parent_path().string()};
                         }};
// Enough that none of the disturbances outlasts the trial.
int RecordedFrames() { return test_support::SoakScale() == 1 ? 1000 : 3000; }
const TrialKind kRecorded = {"recorded", false, [](const fs::path& files, const fs::path& session) {
                               const fs::path trial = WriteMaskTrial(files, RecordedFrames());
                               return std::vector<std::string>{"--json",        "trial",      "run",
                                                               trial.string(),  "--headless", "--session",
                                                               session.string()};
                             }};

TrialKind LiveFrom(const LiveTrialFiles& files) {
  return {"live", true, [&](const fs::path& /*files*/, const fs::path& session) {
            return std::vector<std::string>{
                "--json",     "trial",     "run",           files.trial().string(),
                "--headless", "--session", session.string()};
          }};
}

// What becomes of the session's place once some frames are on the disk.
struct Disturbance {
  std::string name;
  std::function<void(const fs::path& session, int process)> act;
  bool ends_well = true;  // the program exits with 0, every frame on the disk
};

Disturbance LockedFor(milliseconds time) {
  return {"locked for " + std::to_string(time.count() / 1000) + " s",
          [=](const fs::path& session, int /*process*/) {
            SQLite::Database other(session.string(), SQLite::OPEN_READWRITE, 3000);
            other.exec("BEGIN IMMEDIATE");
            std::this_thread::sleep_for(time);
          }};
}

// What is removed is back before anything else is asked for.
Disturbance Removed(const char* name, const std::function<void(const fs::path& session)>& remove) {
  return {name, [remove](const fs::path& session, int process) {
            remove(session);
            (void)WaitForFrames(session, 60, process);
          }};
}
const Disturbance kFileRemoved =
    Removed("file removed", [](const fs::path& session) { fs::remove(session); });
const Disturbance kLogRemoved =
    Removed("-wal removed", [](const fs::path& session) { fs::remove(session.string() + "-wal"); });
const Disturbance kFolderRemoved =
    Removed("folder removed", [](const fs::path& session) { fs::remove_all(session.parent_path()); });

// Runs the trial, disturbs it, and says in a line what came of it.
ProgramRun RunDisturbed(const TrialKind& trial, const Disturbance& disturbance, const fs::path& files,
                        const fs::path& session, std::int64_t* frames_before) {
  constexpr std::int64_t kFramesBefore = 40;
  test_support::RunOptions options = AsInATest();
  options.while_running = [&](int process) {
    *frames_before = WaitForFrames(session, kFramesBefore, process);
    disturbance.act(session, process);
    if (trial.is_live) kill(process, SIGINT);
  };
  ProgramRun run =
      test_support::RunProgram(test_support::ProgramFile(), trial.words(files, session), options);
  std::string told = run.exit_status == 0 ? "" : run.err.substr(0, run.err.find('\n'));
  const nlohmann::json summary = nlohmann::json::parse(run.out, nullptr, false);
  if (!summary.is_discarded()) {
    told = std::to_string(summary["frames_committed"].get<int>()) + " of " +
           std::to_string(summary["frames"].get<int>()) + " frames in " +
           summary["recorded_in"].get<std::string>();
    for (const auto& warning : summary["warnings"]) told += "; " + warning.get<std::string>();
  }
  std::cout << "| " << trial.name << " | " << disturbance.name << " | " << run.exit_status << " | " << told
            << " |\n";
  return run;
}

void ExpectTheTrialGoesOn(const TrialKind& trial, const Disturbance& disturbance) {
  SCOPED_TRACE(std::string(trial.name) + ", " + disturbance.name);
  const TemporaryFolder folder;
  const fs::path session = folder / "out" / "session.db";
  fs::create_directories(session.parent_path());
  std::int64_t frames_before = 0;
  const ProgramRun run = RunDisturbed(trial, disturbance, folder / "files", session, &frames_before);
  ASSERT_EQ(run.exit_status, 0) << run.err;
  const nlohmann::json summary = nlohmann::json::parse(run.out);
  EXPECT_EQ(summary["frames"], summary["frames_committed"]);
  EXPECT_FALSE(summary["warnings"].empty()) << "nobody was told";
  ExpectSound(session, summary["frames"].get<std::int64_t>());
  EXPECT_EQ(sessions::SessionReader(session).status(), sessions::SessionStatus::kComplete);
}

TEST(DisturbedTrial, GoesOnWhereAnotherProgramLocksItsSession) {
  ExpectTheTrialGoesOn(kRecorded, LockedFor(milliseconds(2000)));
  if (test_support::SoakScale() == 1) return;
  for (const int seconds : {2, 7, 30}) {
    ExpectTheTrialGoesOn(kDemo, LockedFor(milliseconds(1000 * seconds)));
    ExpectTheTrialGoesOn(kRecorded, LockedFor(milliseconds(1000 * seconds)));
  }
}

TEST(DisturbedTrial, GoesOnWhileItsCamerasAreLive) {
  std::vector<Disturbance> disturbances = {LockedFor(milliseconds(4000))};
  if (test_support::SoakScale() > 1) {
    disturbances.insert(disturbances.end(), {LockedFor(milliseconds(7000)), LockedFor(milliseconds(30'000)),
                                             kFileRemoved, kLogRemoved, kFolderRemoved});
  }
  for (const Disturbance& disturbance : disturbances) {
    const TemporaryFolder folder;
    const LiveTrialFiles files(folder.path());
    ExpectTheTrialGoesOn(LiveFrom(files), disturbance);
  }
}

TEST(DisturbedTrial, GoesOnWhereItsFilesAreRemoved) {
  for (const Disturbance& disturbance : {kFileRemoved, kLogRemoved, kFolderRemoved}) {
    ExpectTheTrialGoesOn(kRecorded, disturbance);
    if (test_support::SoakScale() > 1) ExpectTheTrialGoesOn(kDemo, disturbance);
  }
}

// The program ends with one line, or with all frames; what was on the disk is there.
void ExpectAnOrderlyEnd(const TrialKind& trial, const Disturbance& disturbance, const fs::path& files,
                        const fs::path& session) {
  SCOPED_TRACE(std::string(trial.name) + ", " + disturbance.name);
  std::int64_t frames_before = 0;
  const ProgramRun run = RunDisturbed(trial, disturbance, files, session, &frames_before);
  ExpectOrderlyEnd(run);
  if (frames_before > 0 || fs::exists(session)) ExpectSound(session, frames_before);
}

// Both in a soak; ./dev test runs the one that is quicker.
std::vector<TrialKind> TrialKinds() {
  return test_support::SoakScale() == 1 ? std::vector{kRecorded} : std::vector{kDemo, kRecorded};
}

TEST(DisturbedTrial, EndsInOrderOnAFullDisk) {
  const std::vector<int> sizes_mb =
      test_support::SoakScale() == 1 ? std::vector{3} : std::vector{3, 5, 8, 12};
  for (const TrialKind& trial : TrialKinds()) {
    for (const int size_mb : sizes_mb) {
      const TemporaryFolder folder;
      const auto disk = DiskMount::InMemory(folder / "disk", size_mb);
      if (!disk) GTEST_SKIP() << "NOT TESTED: no file system may be mounted here";
      const Disturbance full = {"disk of " + std::to_string(size_mb) + " MB", [](const fs::path&, int) {}};
      ExpectAnOrderlyEnd(trial, full, folder / "files", folder / "disk" / "session.db");
    }
  }
}

TEST(DisturbedTrial, EndsInOrderOnADiskThatTurnsReadOnly) {
  for (const TrialKind& trial : TrialKinds()) {
    const TemporaryFolder folder;
    const auto disk = DiskMount::Ext4(folder / "image", folder / "disk");
    if (!disk) GTEST_SKIP() << "NOT TESTED: no file system may be mounted here";
    const Disturbance read_only = {"disk turns read-only",
                                   [&](const fs::path&, int) { EXPECT_TRUE(disk->MakeReadOnly()); }};
    ExpectAnOrderlyEnd(trial, read_only, folder / "files", folder / "disk" / "session.db");
  }
}

TEST(DisturbedTrial, LosesNothingOnTheDiskWhenThePowerFails) {
  const int failures = test_support::SoakScale();  // 20 by ./dev soak
  for (int i = 0; i < failures && !HasFailure(); ++i) {
    const TemporaryFolder folder;
    const TrialKind& trial = i % 2 == 0 ? kRecorded : kDemo;
    const fs::path session = folder / "disk" / "out" / "session.db";
    std::int64_t frames = 0;
    {
      const auto disk = DiskMount::Ext4(folder / "image", folder / "disk");
      if (!disk) GTEST_SKIP() << "NOT TESTED: no file system may be mounted here";
      fs::create_directories(session.parent_path());
      test_support::RunOptions options = AsInATest();
      options.while_running = [&](int process) {
        frames = WaitForFrames(session, 1 + 23 * i, process);
        EXPECT_TRUE(disk->CutPower());
        kill(process, SIGKILL);
      };
      (void)test_support::RunProgram(test_support::ProgramFile(), trial.words(folder / "files", session),
                                     options);
    }
    const auto disk = DiskMount::Ext4(folder / "image", folder / "disk");
    ASSERT_TRUE(disk.has_value());
    ExpectSound(session, frames);
  }
}

}  // namespace
}  // namespace elbowroom::adversary
