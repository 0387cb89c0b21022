#include "tests/adversary/recorded_session.h"

#include <SQLiteCpp/SQLiteCpp.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <chrono>
#include <thread>
#include <vector>

#include "core/error.h"
#include "sessions/session_reader.h"
#include "tests/support/places.h"
#include "tests/support/temporary_folder.h"

namespace elbowroom::adversary {

namespace fs = std::filesystem;

std::optional<std::int64_t> FramesOnDisk(const fs::path& session) {
  try {
    SQLite::Database database(session.string(), SQLite::OPEN_READONLY, 100);
    return database.execAndGet("SELECT count(*) FROM frame").getInt64();
  } catch (const SQLite::Exception&) {
    return std::nullopt;
  }
}

std::int64_t WaitForFrames(const fs::path& session, std::int64_t frames, int process) {
  constexpr std::chrono::milliseconds kLookAfter(5);
  std::int64_t seen = 0;
  while (seen < frames && kill(process, 0) == 0) {
    std::error_code ignored;
    if (fs::exists(session, ignored)) seen = std::max(seen, FramesOnDisk(session).value_or(0));
    std::this_thread::sleep_for(kLookAfter);
  }
  return seen;
}

void ExpectSound(const fs::path& session, std::int64_t frames) {
  const test_support::TemporaryFolder folder;
  const test_support::ProgramRun report =
      test_support::RunProgram(test_support::ProgramFile(),
                               {"report", session.string(), "--out", folder.path().string()}, AsInATest());
  EXPECT_EQ(report.exit_status, 0) << report.err;
  {
    const sessions::SessionReader reader(session);
    const std::vector<sessions::FrameSummary> recorded = reader.frames();
    EXPECT_GE(std::ssize(recorded), frames);
    for (std::size_t i = 0; i < recorded.size(); ++i) {
      ASSERT_EQ(recorded[i].frame, recorded.front().frame + static_cast<int>(i)) << "a hole in the recording";
      (void)reader.ReadFrame(recorded[i].frame);
    }
  }
  SQLite::Database database(session.string(), SQLite::OPEN_READWRITE);
  EXPECT_EQ(database.execAndGet("PRAGMA integrity_check").getString(), "ok");
  EXPECT_FALSE(SQLite::Statement(database, "PRAGMA foreign_key_check").executeStep());
}

void ExpectOrderlyEnd(const test_support::ProgramRun& run) {
  if (run.exit_status == 0) return;
  EXPECT_EQ(run.exit_status, 1) << run.err;
  EXPECT_EQ(std::ranges::count(run.err, '\n'), 1) << run.err;
}

test_support::RunOptions AsInATest() {
  test_support::RunOptions options;
  options.environment = {{"QT_QPA_PLATFORM", "offscreen"}, {"LIBGL_ALWAYS_SOFTWARE", "1"}};
  return options;
}

}  // namespace elbowroom::adversary
