#include "sessions/archive/session_check.h"

#include <SQLiteCpp/SQLiteCpp.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "core/system/file_hash.h"
#include "sessions/session_writer.h"
#include "tests/sessions/sample_session.h"
#include "tests/sessions/sample_trial.h"
#include "tests/support/temporary_folder.h"

namespace elbowroom::tests {
namespace {

using sessions::CheckSession;
using sessions::SessionCheck;
using ::testing::Contains;
using ::testing::HasSubstr;

class SessionCheckTest : public testing::Test {
 protected:
  void Write(double duration_s = 3.0, bool is_finished = true) const {
    WriteTrial(path_, {.duration_s = duration_s,
                       .opened_at_s = 9.0,
                       .touches = {{0, 1.0, 2.0, 5.0}},
                       .is_finished = is_finished});
  }
  void Change(const std::string& sql) const {
    SQLite::Database database(path_.string(), SQLite::OPEN_READWRITE);
    database.exec("PRAGMA foreign_keys = OFF");
    database.exec(sql);
  }
  [[nodiscard]] SessionCheck Check() const { return CheckSession(path_, {}, {}); }

  test_support::TemporaryFolder folder_;
  std::filesystem::path path_ = folder_ / "s.db";
};

TEST_F(SessionCheckTest, FindsNothingWrongWithASoundOne) {
  Write();
  const SessionCheck check = Check();
  EXPECT_TRUE(check.is_sound()) << check.problems.front();
  EXPECT_EQ(check.frames, 30);
  EXPECT_GT(check.silhouettes, 0);
  EXPECT_EQ(check.silhouettes % check.frames, 0);
  EXPECT_GT(check.meshes, 0);
  EXPECT_TRUE(check.gaps.empty());
}

TEST_F(SessionCheckTest, NamesFramesThatAreMissing) {
  Write();
  for (const char* table : {"contact_point", "contact", "clearance", "part_motion", "part_frame",
                            "camera_stamp", "silhouette", "frame_spacing", "frame"})
    Change(std::string("DELETE FROM ") + table + " WHERE frame_index IN (4, 5, 6, 9)");
  const SessionCheck check = Check();
  ASSERT_EQ(check.gaps.size(), 2U);
  EXPECT_EQ(check.gaps[0].first, 4);
  EXPECT_EQ(check.gaps[0].end, 7);
  EXPECT_THAT(check.problems, Contains(HasSubstr("frames 4 to 6 are missing")));
  EXPECT_THAT(check.problems, Contains(HasSubstr("frame 9 is missing")));
}

TEST_F(SessionCheckTest, ReadsEverySilhouette) {
  Write();
  // An empty frame of zstd.
  Change(
      "UPDATE mask SET words_zstd = x'28b52ffd2000010000' WHERE mask_id = (SELECT max(mask_id) FROM mask)");
  const SessionCheck check = Check();
  ASSERT_FALSE(check.is_sound());
  EXPECT_THAT(check.problems.front(), HasSubstr("frame"));
  EXPECT_EQ(check.frames, 30) << "it goes on";
}

TEST_F(SessionCheckTest, TellsAFileThatCannotBeOpened) {
  const SessionCheck none = Check();
  ASSERT_EQ(none.problems.size(), 1U);
  EXPECT_THAT(none.problems[0], HasSubstr("s.db"));
  std::ofstream(path_) << std::string(5000, 'x');
  EXPECT_FALSE(Check().is_sound());
}

TEST_F(SessionCheckTest, NotesASessionThatWasCutOff) {
  Write(3.0, false);
  const SessionCheck check = Check();
  EXPECT_TRUE(check.is_sound());
  ASSERT_EQ(check.notes.size(), 1U);
  EXPECT_THAT(check.notes[0], HasSubstr("cut off"));
}

TEST_F(SessionCheckTest, ComparesFootageWithItsChecksums) {
  const core::SessionHeader header = SampleHeader();
  const std::filesystem::path video = folder_ / "cam1.mkv";
  std::ofstream(video) << "pictures";
  {
    sessions::SessionWriter writer(path_, header);
    writer.Append(SampleFrame(header, 0, 1));
    sessions::SessionClosing closing;
    closing.footage = {{"cam1.mkv", 8, core::HashOfFile(video)}};
    writer.Finish({}, closing);
  }
  EXPECT_TRUE(Check().is_sound());
  EXPECT_EQ(Check().footage_files, 1);
  std::ofstream(video) << "Pictures";
  EXPECT_THAT(Check().problems, Contains(HasSubstr("isn't the one that was recorded")));
  std::filesystem::remove(video);
  EXPECT_THAT(Check().problems, Contains(HasSubstr("isn't there")));
}

}  // namespace
}  // namespace elbowroom::tests
