#include "sessions/review_editor.h"

#include <SQLiteCpp/SQLiteCpp.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/error.h"
#include "sessions/schema/schema.h"
#include "sessions/session_reader.h"
#include "sessions/session_writer.h"
#include "tests/sessions/expect_error.h"
#include "tests/sessions/sample_session.h"
#include "tests/support/places.h"
#include "tests/support/temporary_folder.h"

namespace elbowroom::tests {
namespace {

using core::ReviewStatus;
using sessions::AddRemarks;
using sessions::FindingRemark;
using sessions::SessionReader;

std::vector<core::Finding> FindingsOf(const std::filesystem::path& path) {
  return SessionReader(path).findings();
}

core::Finding FindingWith(const std::filesystem::path& path, const core::FindingId& id) {
  for (const core::Finding& finding : FindingsOf(path))
    if (finding.id == id) return finding;
  return {};
}

TEST(ReviewEditor, AddsToWhatWasSaidBefore) {
  const test_support::TemporaryFolder folder;
  const auto path = folder / "s.db";
  WriteSampleSession(path, 3);
  const core::Finding before = FindingsOf(path).front();
  const core::ReviewRemark first{"2024-05-01T00:00:00Z", "Ann", ReviewStatus::kActive,
                                 "look \xE2\x80\xAE here"},
      second{"2024-05-01T00:00:01Z", "Bo", {}, std::string(10'000, 'x'), std::string(32, '9')};
  AddRemarks(path, std::vector<FindingRemark>{{before.id, first}, {before.id, second}});
  const core::Finding after = FindingWith(path, before.id);
  ASSERT_EQ(after.remarks.size(), before.remarks.size() + 2);
  EXPECT_EQ(after.remarks.end()[-2], first);
  EXPECT_EQ(after.remarks.back(), second);
  EXPECT_EQ(after.status(), ReviewStatus::kActive);
  EXPECT_FALSE(std::filesystem::exists(folder / "s.db-wal")) << "a session that has ended is one file";
}

TEST(ReviewEditor, BringsOlderFilesToTheNewestSchema) {
  for (int schema = 1; schema <= sessions::kSchemaVersion; ++schema) {
    const test_support::TemporaryFolder folder;
    const auto path = folder / "s.db";
    std::filesystem::copy_file(test_support::SourceFolder() / "tests/sessions/stored" /
                                   ("session_schema_" + std::to_string(schema) + ".db"),
                               path);
    const std::vector<core::Finding> before = FindingsOf(path);
    ASSERT_FALSE(before.empty());
    AddRemarks(path, std::vector<FindingRemark>{{before[0].id, {"t", "Ann", ReviewStatus::kApproved, ""}}});
    const std::vector<core::Finding> after = FindingsOf(path);
    ASSERT_EQ(after.size(), before.size());
    for (std::size_t i = 0; i < after.size(); ++i) EXPECT_EQ(after[i].id, before[i].id) << schema;
    EXPECT_EQ(FindingWith(path, before[0].id).status(), ReviewStatus::kApproved) << schema;
    EXPECT_EQ(SessionReader(path).file_schema(), sessions::kSchemaVersion);
  }
}

TEST(ReviewEditor, LeavesARecordingAlone) {
  const test_support::TemporaryFolder folder;
  const auto path = folder / "s.db";
  const core::SessionHeader header = SampleHeader();
  sessions::SessionWriter writer(path, header);
  writer.Append(SampleFrame(header, 0, 1));
  const std::vector<FindingRemark> remarks{{std::string(32, 'a'), {"t", "Ann", ReviewStatus::kApproved, ""}}};
  ExpectError([&] { AddRemarks(path, remarks); }, core::ErrorKind::kFile, "is being recorded");
  writer.Finish({}, {});
}

TEST(ReviewEditor, AllOrNone) {
  const test_support::TemporaryFolder folder;
  const auto path = folder / "s.db";
  WriteSampleSession(path, 3);
  const core::Finding before = FindingsOf(path).front();
  const std::vector<FindingRemark> remarks{{before.id, {"t", "Ann", ReviewStatus::kApproved, ""}},
                                           {"short", {"t", "Ann", ReviewStatus::kApproved, ""}}};
  EXPECT_THROW(AddRemarks(path, remarks), core::Error);
  EXPECT_EQ(FindingWith(path, before.id).remarks.size(), before.remarks.size());
}

TEST(ReviewEditor, SaysThatAFileCannotBeWritten) {
  if (::geteuid() == 0) GTEST_SKIP() << "root writes everywhere";
  const test_support::TemporaryFolder folder;
  const auto path = folder / "s.db";
  WriteSampleSession(path, 1);
  ASSERT_EQ(::chmod(path.c_str(), 0444), 0);
  ExpectError([&] { AddRemarks(path, {}); }, core::ErrorKind::kDatabase, "s.db");
}

}  // namespace
}  // namespace elbowroom::tests
