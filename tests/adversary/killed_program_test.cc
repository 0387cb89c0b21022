// The program killed at any moment of a trial, a demo or the window: its session has every frame that was on
// the disk, and can be reported.
#include <gtest/gtest.h>
#include <signal.h>

#include <array>
#include <chrono>
#include <functional>
#include <iostream>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "sessions/session_reader.h"
#include "tests/adversary/recorded_session.h"
#include "tests/adversary/sample_trial_files.h"
#include "tests/support/places.h"
#include "tests/support/soak.h"
#include "tests/support/temporary_folder.h"

namespace elbowroom::adversary {
namespace {

namespace fs = std::filesystem;
using test_support::ProgramRun;
using test_support::TemporaryFolder;

// ./dev soak's scale of 20 makes 200 in all.
constexpr int kKillsAScale = 10, kKillsInASmokeTest = 4;

struct Victim {
  const char* name;
  // The words that record into `session`; files that it takes are made in the session's folder.
  std::function<std::vector<std::string>(const fs::path& session)> words;
  std::int64_t frames;  // about as many come
};

const std::vector<Victim>& Victims() {
  static const std::vector<Victim> victims = {
      {"trial",
       [](const fs::path& session) {
         const fs::path trial = WriteMaskTrial(session.parent_path() / "trial", 400);
         return std::vector<std::string>{"trial",      "run",       trial.string(),
                                         "--headless", "--session", session.string()};
       },
       400},
      {"demo",
       [](const fs::path& session) {
         return std::vector<std::string>{"demo", "--headless", "--out", session.parent_path().string()};
       },
       480},
      {"window",
       [](const fs::path& session) {
         return std::vector<std::string>{"demo", "--out", session.parent_path().string()};
       },
       60}};
  return victims;
}

// Kills once so many frames are on the disk, and a random moment later: within a frame's time or, every
// third, long enough to meet what ends a trial.
ProgramRun RunAndKill(const Victim& victim, const fs::path& session, int signal, std::mt19937_64& random,
                      std::int64_t* frames_before) {
  const auto after_frames = static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(victim.frames));
  const std::chrono::milliseconds later(random() % 3 == 0 ? random() % 1500 : random() % 30);
  test_support::RunOptions options = AsInATest();
  options.while_running = [&](int process) {
    *frames_before = WaitForFrames(session, after_frames, process);
    std::this_thread::sleep_for(later);
    kill(process, signal);
  };
  return test_support::RunProgram(test_support::ProgramFile(), victim.words(session), options);
}

TEST(KilledProgram, LeavesEveryFrameThatWasOnTheDisk) {
  std::mt19937_64 random(4711);
  const int scale = test_support::SoakScale();
  const int kills = scale == 1 ? kKillsInASmokeTest : kKillsAScale * scale;
  int without_session = 0;
  for (int i = 0; i < kills && !HasFailure(); ++i) {
    const TemporaryFolder folder;
    const fs::path session = folder / "session.db";
    // Trials are quick, and as good as the others: three of five.
    constexpr std::array<std::size_t, 5> kTurns = {0, 1, 0, 2, 0};
    const Victim& victim = Victims()[kTurns[static_cast<std::size_t>(i) % kTurns.size()]];
    std::int64_t frames_before = 0;
    SCOPED_TRACE(std::string(victim.name) + ", kill " + std::to_string(i));
    (void)RunAndKill(victim, session, SIGKILL, random, &frames_before);
    // What a killed program leaves may be a journal to be rolled back, which SQLite can't do read-only.
    if (frames_before == 0 && !FramesOnDisk(session)) {
      ++without_session;
    } else {
      ExpectSound(session, frames_before);
    }
  }
  std::cout << kills << " kills, " << without_session << " before there was a session\n";
}

class EndedWindow : public testing::TestWithParam<int> {};

TEST_P(EndedWindow, EndsItsTrialInOrder) {
  std::mt19937_64 random(static_cast<std::uint64_t>(GetParam()));
  const TemporaryFolder folder;
  const fs::path session = folder / "session.db";
  std::int64_t frames_before = 0;
  test_support::RunOptions options = AsInATest();
  options.while_running = [&](int process) {
    frames_before = WaitForFrames(session, 20, process);
    kill(process, GetParam());
  };
  const ProgramRun run = test_support::RunProgram(test_support::ProgramFile(),
                                                  {"demo", "--out", folder.path().string()}, options);
  EXPECT_EQ(run.exit_status, 0) << run.err;
  ExpectSound(session, frames_before);
  EXPECT_EQ(sessions::SessionReader(session).status(), sessions::SessionStatus::kComplete);
}

INSTANTIATE_TEST_SUITE_P(Signals, EndedWindow, testing::Values(SIGINT, SIGTERM, SIGHUP));

}  // namespace
}  // namespace elbowroom::adversary
