// A damaged session file is told from a sound one, and what it still holds can be salvaged.
#include <SQLiteCpp/SQLiteCpp.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <stop_token>

#include "sessions/database/damage.h"
#include "sessions/database/query_limit.h"
#include "sessions/database/statement.h"
#include "sessions/packing.h"
#include "sessions/schema/schema.h"
#include "sessions/schema/schema_check.h"
#include "sessions/session_reader.h"
#include "tests/sessions/expect_error.h"
#include "tests/sessions/sample_session.h"
#include "tests/support/places.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_file.h"

namespace elbowroom::tests {
namespace {

namespace fs = std::filesystem;
using core::ErrorKind;
using sessions::SessionReader;
using test_support::TemporaryFolder;

constexpr const char* kEndless =
    "WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n) SELECT count(*) FROM n";

fs::path SampleIn(const TemporaryFolder& folder, core::FrameIndex frames = 6) {
  fs::remove(folder / "s.db");
  WriteSampleSession(folder / "s.db", frames);
  return folder / "s.db";
}

void Execute(const fs::path& path, const std::string& sql) {
  SQLite::Database(path.string(), SQLite::OPEN_READWRITE)
      .exec("PRAGMA foreign_keys = OFF; PRAGMA ignore_check_constraints = ON; PRAGMA writable_schema = ON; " +
            sql);
}

void ExpectRefused(const fs::path& path, const std::string& says) {
  ExpectError([&] { SessionReader{path}; }, ErrorKind::kFormat, says);
  ExpectError([&] { SessionReader{path}; }, ErrorKind::kFormat, path.string());
}

TEST(DamagedSession, NamesTheTableAndTheRowThatIsMissing) {
  const TemporaryFolder folder;
  const auto refused_after = [&](const char* sql, const char* says) {
    const fs::path path = SampleIn(folder);
    Execute(path, sql);
    ExpectRefused(path, says);
  };
  refused_after("DELETE FROM frame_spacing WHERE frame_index = 5",
                "rows are missing: table 'frame_spacing' has 10, where 6 frames of 2 belong");
  refused_after("DELETE FROM part_frame WHERE frame_index = 1 AND part_index = 2",
                "a row of 'clearance' refers to one of 'part_frame' that isn't there");
  refused_after("UPDATE silhouette SET mask_id = 999 WHERE frame_index = 0",
                "a row of 'silhouette' refers to one of 'mask' that isn't there");
  refused_after(
      "UPDATE camera SET camera_index = camera_index + 10; UPDATE silhouette SET camera_index = camera_index "
      "+ 10; UPDATE camera_stamp SET camera_index = camera_index + 10",
      "camera 10 comes where 0 belongs");
  refused_after("UPDATE part_frame SET verdict = 'perhaps'", "CHECK constraint failed");
  refused_after("DELETE FROM camera_stamp WHERE frame_index = 3 AND camera_index = 1",
                "frame 3 has 1 rows in table 'camera_stamp', where it has one a camera, or none");
  refused_after("UPDATE camera_stamp SET camera_index = 7 WHERE camera_index = 1",
                "a row of 'camera_stamp' refers to one of 'camera' that isn't there");
}

// Ids become names of files and attributes.
TEST(DamagedSession, AnIdHasHexDigitsOnly) {
  const TemporaryFolder folder;
  const char* bad = "printf('%.*c', 32, 'g')";
  for (const char* column : {"episode SET finding_id", "near_miss SET finding_id",
                             "absent_finding SET finding_id", "remark SET exchange_id"}) {
    const fs::path path = SampleIn(folder);
    const std::string table(column, std::string_view(column).find(' '));
    Execute(path, fmt::format("UPDATE {} = {} WHERE finding_id = (SELECT min(finding_id) FROM {})", column,
                              bad, table));
    ExpectError([&] { (void)SessionReader(path).findings(); }, ErrorKind::kFormat,
                "where 32 hexadecimal digits belong");
  }
}

TEST(DamagedSession, TablesAndViewsMustBeThoseOfTheSchema) {
  const TemporaryFolder folder;
  const auto refused_after = [&](const char* sql, const char* says) {
    const fs::path path = SampleIn(folder);
    Execute(path, sql);
    ExpectRefused(path, says);
  };
  refused_after("DROP VIEW v_part; CREATE VIEW v_part AS SELECT 1 AS part_index",
                "its view 'v_part' isn't the view");
  refused_after("DROP VIEW v_event; DROP TABLE event; CREATE VIEW event AS SELECT 1 AS event_id",
                "its view 'event' isn't the table");
  refused_after("ALTER TABLE frame RENAME COLUMN time_s TO when_s", "its table 'frame' isn't the table");
  refused_after("DROP INDEX contact_by_part", "its index 'contact_by_part' is missing");
  refused_after("CREATE TRIGGER mine AFTER INSERT ON frame BEGIN SELECT 1; END", "it has a trigger, 'mine'");
  refused_after("CREATE INDEX mine ON frame (('aaaaaaaaaaaaaaaaaaaaaaaaaaaaaaa' LIKE '%a%a%a%a%a%a%a%a%b'))",
                "its index 'mine' is one of expressions");
  refused_after("CREATE INDEX mine ON frame (time_s) WHERE time_s > 1", "is one of expressions");
  refused_after("PRAGMA user_version = 4", "isn't the table that schema 4 has");
  refused_after("PRAGMA user_version = 0", "it has tables, but of schema 0");
  refused_after("PRAGMA user_version = -1", "it has schema -1");
}

TEST(DamagedSession, EverySchemaOnRecordIsItself) {
  for (std::int64_t schema = 1; schema <= sessions::kSchemaVersion; ++schema) {
    const fs::path stored =
        test_support::SourceFolder() / fmt::format("tests/sessions/stored/session_schema_{}.db", schema);
    sessions::Database database = sessions::Database::OpenReadOnly(stored);
    EXPECT_NO_THROW(sessions::RequireTablesOfSchema(database, schema));
    for (std::int64_t other = 1; other <= sessions::kSchemaVersion; ++other) {
      // A later schema has all of an earlier one's tables and more.
      if (other <= schema) continue;
      EXPECT_THROW(sessions::RequireTablesOfSchema(database, other), core::Error) << other;
    }
  }
}

TEST(DamagedSession, ATextMustBeOneThatWasWritten) {
  const TemporaryFolder folder;
  const fs::path path = SampleIn(folder);
  Execute(path,
          "UPDATE part SET name = CAST(x'41ff42' AS TEXT) WHERE part_index = 0; "
          "UPDATE session SET task = 'two' || char(10) || 'lines'");
  const SessionReader reader(path);
  EXPECT_EQ(reader.header().layout.parts[0].name,
            "A\xEF\xBF\xBD"
            "B");
  EXPECT_EQ(reader.header().trial.task, "two\nlines");
  Execute(path, "UPDATE session SET participant = printf('%.*c', 2000000, 'x')");
  ExpectRefused(path, "column participant holds a text of 2000000 bytes");
}

TEST(QueryLimit, EndsWhatNeverEnds) {
  const TemporaryFolder folder;
  sessions::Database database = sessions::Database::OpenReadOnly(SampleIn(folder));
  const sessions::QueryLimit limit(database, {});
  sessions::Statement endless(database, kEndless);
  ExpectError([&] { limit.Guarded([&] { endless.Run(); }); }, ErrorKind::kFormat, "million steps");
}

TEST(QueryLimit, AStatementWithinAnothersRowsCountsAsPartOfIt) {
  const TemporaryFolder folder;
  sessions::Database database = sessions::Database::OpenReadOnly(SampleIn(folder));
  const sessions::QueryLimit limit(database, {});
  sessions::Statement endless(
      database, "WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n) SELECT i FROM n");
  sessions::Statement within(database, "SELECT count(*) FROM frame");
  const auto run = [&] {
    while (endless.Next()) within.With().Run();
  };
  ExpectError([&] { limit.Guarded(run); }, ErrorKind::kFormat, "million steps");
}

TEST(QueryLimit, EndsWhatNobodyWaitsFor) {
  const TemporaryFolder folder;
  const fs::path path = SampleIn(folder, 60);
  sessions::Database database = sessions::Database::OpenReadOnly(path);
  std::stop_source stop;
  const sessions::QueryLimit limit(database, stop.get_token());
  stop.request_stop();
  sessions::Statement endless(database, kEndless);
  ExpectError([&] { limit.Guarded([&] { endless.Run(); }); }, ErrorKind::kCancelled, path.string());
  ExpectError([&] { SessionReader(path, stop.get_token()); }, ErrorKind::kCancelled, path.string());
}

// What opening the session says to one who may read it and not write it. In a process of its own, whose files
// may not grow beyond so many bytes.
std::string SaidToReader(const TemporaryFolder& folder, const fs::path& path,
                         rlim_t most_bytes = RLIM_INFINITY) {
  constexpr auto kRead = static_cast<fs::perms>(0444), kEnter = static_cast<fs::perms>(0555);
  fs::permissions(folder.path(), kEnter);
  fs::permissions(path, kRead);
  std::array<int, 2> pipe_ends{};
  if (::pipe(pipe_ends.data()) != 0) return "no pipe";
  const pid_t child = fork();
  if (child == 0) {
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{most_bytes, most_bytes};
    std::string said = "sound";
    try {
      constexpr uid_t kNobody = 65534;
      if ((::geteuid() == 0 && ::setuid(kNobody) != 0) || setrlimit(RLIMIT_FSIZE, &limit) != 0) _exit(1);
      if (::access(path.c_str(), W_OK) == 0) _exit(1);
      SessionReader reader(path);
    } catch (const std::exception& error) {
      said = error.what();
    }
    _exit(::write(pipe_ends[1], said.data(), said.size()) == std::ssize(said) ? 0 : 1);
  }
  ::close(pipe_ends[1]);
  std::string said(4096, ' ');
  said.resize(static_cast<std::size_t>(std::max<ssize_t>(::read(pipe_ends[0], said.data(), said.size()), 0)));
  ::close(pipe_ends[0]);
  int status = 1;
  (void)waitpid(child, &status, 0);
  fs::permissions(folder.path(), fs::perms::owner_all);
  return WIFEXITED(status) && WEXITSTATUS(status) == 0 ? said : "the process failed";
}

// SQLite checks rows only through a connection that could write: here it has a copy.
TEST(DamagedSession, IsFoundAlsoWhereTheFileCannotBeWritten) {
  const TemporaryFolder folder;
  const fs::path path = SampleIn(folder);
  EXPECT_EQ(SaidToReader(folder, path), "sound");
  fs::permissions(path, fs::perms::owner_all);
  Execute(path, "UPDATE part_frame SET verdict = 'perhaps'");
  EXPECT_THAT(SaidToReader(folder, path), testing::HasSubstr("CHECK constraint failed"));
}

TEST(DamagedSession, ACheckWithoutRoomForItsCopySaysSo) {
  const TemporaryFolder folder;
  const fs::path path = SampleIn(folder);
  Execute(path,
          "CREATE TABLE more (bytes BLOB); INSERT INTO more VALUES (zeroblob(8000000)); DROP TABLE more");
  EXPECT_THAT(SaidToReader(folder, path, 8192), testing::HasSubstr("temporary copy"));
}

// A file that may be written isn't copied, and opening it changes no byte.
TEST(DamagedSession, IsLookedForInTheFileItself) {
  const TemporaryFolder folder;
  const fs::path path = SampleIn(folder);
  const std::string before = test_support::ReadText(path);
  const auto time = fs::last_write_time(path);
  { const SessionReader reader(path); }
  EXPECT_EQ(test_support::ReadText(path), before);
  EXPECT_EQ(fs::last_write_time(path), time);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator()), 1);
}

// The limit must be far from what a sound session takes.
TEST(QueryLimit, ASoundSessionTakesNoTenthOfIt) {
  const TemporaryFolder folder;
  const fs::path path = SampleIn(folder, 150);
  const SessionReader reader(path);
  (void)reader.frames();
  (void)reader.contacts();
  (void)reader.clearances();
  (void)reader.part_totals();
  (void)reader.near_misses();
  const auto bytes = static_cast<std::int64_t>(fs::file_size(path));
  const std::int64_t per_byte_alone = sessions::MostStepsFor(bytes) - sessions::MostStepsFor(0);
  EXPECT_GT(reader.most_steps_taken(), 0);
  EXPECT_LT(reader.most_steps_taken() * 10, per_byte_alone) << bytes;
}

TEST(Damage, AMessageQuotesOneLineOfUtf8) {
  EXPECT_EQ(sessions::Quotable("a\nb\x01"
                               "c\x7F"),
            "a b c ");
  EXPECT_EQ(sessions::Quotable("\xC3\xA4\xFF"), "\xC3\xA4\xEF\xBF\xBD");
  EXPECT_EQ(sessions::Quotable(std::string(500, 'x'), 10), std::string(10, 'x') + "\xE2\x80\xA6");
  for (const char* bad : {"\xC0\x80", "\xED\xA0\x80", "\xF4\x90\x80\x80", "\xE2\x82", "\x80", "\xF8"})
    EXPECT_EQ(sessions::AsUtf8(bad).find("\xEF\xBF\xBD"), 0U);
  for (const char* good : {"plain", "\xE2\x82\xAC", "\xF0\x9F\x94\xA7", "\xED\x9F\xBF"})
    EXPECT_EQ(sessions::AsUtf8(good), good);
}

TEST(Packing, AClaimBeyondAllBoundsTakesNoMemory) {
  // Two frames that claim 16 GB and a mask of 2 GB: refused before anything of that size is made.
  const auto frame_claiming = [](std::uint64_t size) {
    sessions::Bytes frame = {std::byte{0x28}, std::byte{0xB5}, std::byte{0x2F}, std::byte{0xFD},
                             std::byte{0xE0}};
    for (unsigned i = 0; i < 8; ++i) frame.push_back(static_cast<std::byte>(size >> (8 * i)));
    return frame;
  };
  constexpr std::size_t kMany = std::size_t{1} << 31U;
  const sessions::Bytes vertices = frame_claiming(24 * kMany), triangles = frame_claiming(12 * kMany);
  ExpectError([&] { (void)sessions::UnpackMesh(vertices, kMany, triangles, kMany, "mesh"); },
              ErrorKind::kFormat, "it claims 2147483648 values");
  ExpectError([&] { (void)sessions::UnpackMesh(vertices, std::size_t{0} - 1, triangles, 1, "mesh"); },
              ErrorKind::kFormat, "mesh");
  const sessions::Bytes words = frame_claiming(std::uint64_t{65536} * 65536 / 8);
  ExpectError([&] { (void)sessions::UnpackMask(words, std::nullopt, 65536, 65536, {}, "mask"); },
              ErrorKind::kFormat, "the packed data claims 536870912 bytes");
}

// As docs/session_database.md says.
TEST(DamagedSession, WhatItHoldsCanBeSalvaged) {
  const TemporaryFolder folder;
  const fs::path path = SampleIn(folder);
  Execute(path,
          "DELETE FROM frame_spacing WHERE frame_index = 5; "
          "UPDATE sqlite_schema SET rootpage = (SELECT rootpage FROM sqlite_schema WHERE name = "
          "'contact_by_part') "
          "WHERE name = 'event_by_frame'");
  ExpectRefused(path, "the integrity check says");
  const std::string salvage =
      "(sqlite3 s.db .dump | sed 's/^ROLLBACK;.*/COMMIT;/'; "
      "echo 'PRAGMA application_id = 1164730999; PRAGMA user_version = 11;') | sqlite3 saved.db";
  ASSERT_EQ(
      test_support::RunProgram("/bin/bash", {"-c", salvage}, {.working_folder = folder.path()}).exit_status,
      0);
  ExpectRefused(folder / "saved.db", "rows are missing: table 'frame_spacing'");
  Execute(folder / "saved.db",
          "DELETE FROM contact_point WHERE frame_index = 5; DELETE FROM contact WHERE frame_index = 5; "
          "DELETE FROM clearance WHERE frame_index = 5; DELETE FROM part_motion WHERE frame_index = 5; "
          "DELETE FROM part_frame WHERE frame_index = 5; DELETE FROM silhouette WHERE frame_index = 5; "
          "DELETE FROM frame_spacing WHERE frame_index = 5; DELETE FROM frame WHERE frame_index = 5; "
          "UPDATE episode SET end_frame = 4 WHERE end_frame = 5; UPDATE near_miss SET end_frame = 4 WHERE "
          "end_frame = 5");
  const SessionReader saved(folder / "saved.db");
  EXPECT_EQ(saved.frame_count(), 5);
  EXPECT_EQ(saved.episodes().size(), 2U);
}

}  // namespace
}  // namespace elbowroom::tests
