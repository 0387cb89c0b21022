#include <SQLiteCpp/SQLiteCpp.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <random>

#include "sessions/session_reader.h"
#include "sessions/session_writer.h"
#include "tests/sessions/sample_session.h"
#include "tests/support/temporary_folder.h"

namespace elbowroom::tests {
namespace {

using test_support::TemporaryFolder;

// The child: records for ever and tells through `pipe` how many frames are committed.
[[noreturn]] void RecordForEver(const std::filesystem::path& path, std::uint32_t seed, int pipe) {
  const core::SessionHeader header = SampleHeader();
  sessions::SessionWriter writer(path, header);
  for (core::FrameIndex i = 0;; ++i) {
    writer.Append(SampleFrame(header, i, seed));
    const std::int64_t committed = writer.frames_committed();
    if (write(pipe, &committed, sizeof committed) != sizeof committed) _exit(1);
  }
}

// Records in another process, kills it once it has said `kill_after` times what is committed; returns the
// last number that it said.
std::int64_t RecordAndKill(const std::filesystem::path& path, std::uint32_t seed, int kill_after) {
  int ends[2];
  if (pipe(ends) != 0) throw std::runtime_error("no pipe");
  const pid_t child = fork();
  if (child == 0) {
    close(ends[0]);
    RecordForEver(path, seed, ends[1]);
  }
  close(ends[1]);
  std::int64_t committed = -1;
  for (int i = 0; i < kill_after; ++i) {
    if (read(ends[0], &committed, sizeof committed) != sizeof committed)
      throw std::runtime_error("the child ended early");
  }
  kill(child, SIGKILL);
  std::int64_t said_later = 0;
  while (read(ends[0], &said_later, sizeof said_later) == sizeof said_later) committed = said_later;
  close(ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_TRUE(WIFSIGNALED(status));
  return committed;
}

class KilledWriter : public testing::TestWithParam<std::uint32_t> {};

TEST_P(KilledWriter, LeavesEveryCommittedFrame) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder / "s.db";
  const std::uint32_t seed = GetParam();
  std::mt19937 random(seed);
  const std::int64_t committed = RecordAndKill(path, seed, std::uniform_int_distribution(1, 400)(random));
  {
    const sessions::SessionReader reader(path);
    EXPECT_EQ(reader.status(), sessions::SessionStatus::kCutOff);
    EXPECT_GE(reader.frame_count(), committed);
    ExpectEqual(reader.header(), SampleHeader());
    const std::vector<sessions::FrameSummary> frames = reader.frames();
    for (std::size_t i = 0; i < frames.size(); ++i) {
      ASSERT_EQ(frames[i].frame, static_cast<core::FrameIndex>(i)) << "a hole in the recording";
      ExpectEqual(reader.ReadFrame(frames[i].frame), SampleFrame(reader.header(), frames[i].frame, seed));
    }
  }
  SQLite::Database database(path.string(), SQLite::OPEN_READWRITE);
  EXPECT_EQ(database.execAndGet("PRAGMA integrity_check").getString(), "ok");
  EXPECT_FALSE(SQLite::Statement(database, "PRAGMA foreign_key_check").executeStep());
}

INSTANTIATE_TEST_SUITE_P(Seeds, KilledWriter, testing::Range(1U, 9U));

}  // namespace
}  // namespace elbowroom::tests
