// The demo, whole: what a newcomer runs first.
#include <gtest/gtest.h>

#include "sessions/session_reader.h"
#include "tests/support/places.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_file.h"

namespace elbowroom {
namespace {

constexpr core::PartIndex kPayloadA = 1;

TEST(Demo, TouchesPayloadAAt140MmAndNothingAt240) {
  const test_support::TemporaryFolder folder;
  const std::filesystem::path out = folder / "out";
  const test_support::ProgramRun run =
      test_support::RunProgram(test_support::ProgramFile(), {"demo", "--out", out.string(), "--headless"});
  ASSERT_EQ(run.exit_status, 0) << run.err;
  for (const char* file :
       {"session.db", "report.html", "report.pdf", "contacts.csv", "clearance.csv", "view.png"}) {
    EXPECT_GT(std::filesystem::file_size(out / file), 1000U) << file;
  }
  const sessions::SessionReader session(out / "session.db");
  EXPECT_EQ(session.status(), sessions::SessionStatus::kComplete);
  ASSERT_EQ(session.header().layout.parts[kPayloadA].name, "payload_a");
  EXPECT_EQ(session.header().trial.estimate_mm, 184.0);  // 5.6 cm less than what the task needs with tongs
  const std::string report = test_support::ReadText(out / "report.html");
  EXPECT_NE(report.find("estimate of 184&nbsp;mm lies above what was touched and was not tried"),
            std::string::npos);
  int touches_at_140 = 0;
  for (const sessions::ContactRow& row : session.contacts()) {
    EXPECT_EQ(row.contact.part, kPayloadA) << "frame " << row.frame;
    EXPECT_EQ(row.spacing_mm.at(0), 140.0) << "frame " << row.frame;
    touches_at_140 += 1;
  }
  EXPECT_GT(touches_at_140, 100);  // of 240 frames
  EXPECT_EQ(session.frame_count(), 480);
  EXPECT_EQ(session.episodes().size(), 2U);  // the pipe, then the tongs: two long touches
  EXPECT_EQ(session.episodes()[0].tools, std::vector<std::string>{});
  EXPECT_EQ(session.episodes()[1].tools, std::vector<std::string>{"tongs"});
  for (const core::NearMiss& miss : session.near_misses())
    EXPECT_EQ(miss.part, 0U) << "the hand by the PMT box";
  EXPECT_EQ(session.near_misses().size(), 2U);  // once in each play of the task
  ASSERT_EQ(session.heat_maps().size(), 1U);
  EXPECT_EQ(session.heat_maps()[0].part, kPayloadA);
  // The database answers to sqlite3 itself.
  const test_support::ProgramRun sql = test_support::RunProgram(
      "/usr/bin/sqlite3",
      {(out / "session.db").string(), "SELECT count(*) FROM v_contact WHERE part = 'payload_a'"});
  EXPECT_EQ(sql.out, std::to_string(touches_at_140) + "\n") << sql.err;
}

}  // namespace
}  // namespace elbowroom
