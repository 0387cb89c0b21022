#include "sessions/schema.h"

#include <SQLiteCpp/SQLiteCpp.h>
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "sessions/session_reader.h"
#include "tests/sessions/expect_error.h"
#include "tests/sessions/sample_session.h"
#include "tests/support/temporary_folder.h"

namespace elbowroom::tests {
namespace {

using sessions::SessionReader;
using test_support::TemporaryFolder;

const std::filesystem::path kStored = std::filesystem::path(ELBOWROOM_SOURCE_DIR) / "tests/sessions/stored";

std::string Contents(const std::filesystem::path& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

std::string SchemaOf(const std::filesystem::path& path) {
  SQLite::Database database(path.string());
  SQLite::Statement rows(database, "SELECT sql FROM sqlite_schema WHERE sql IS NOT NULL ORDER BY rowid");
  std::string text;
  while (rows.executeStep()) text += rows.getColumn(0).getString() + ";\n\n";
  return text;
}

// A released schema never changes: whoever needs another writes the next migration, and stores a session of
// the old schema beside this text.
TEST(Schema, EveryVersionIsTheOneOnRecord) {
  const TemporaryFolder folder;
  sessions::Database::Create(folder / "1.db").Execute(sessions::Schema1Sql());
  EXPECT_EQ(SchemaOf(folder / "1.db"), Contents(kStored / "schema_1.sql"));
  sessions::Database second = sessions::Database::Create(folder / "2.db");
  second.Execute(sessions::Schema1Sql());
  second.Execute(sessions::Schema2Sql());
  EXPECT_EQ(SchemaOf(folder / "2.db"), Contents(kStored / "schema_2.sql"));
  sessions::Database third = sessions::Database::Create(folder / "3.db");
  for (const std::string& sql : {sessions::Schema1Sql(), sessions::Schema2Sql(), sessions::Schema3Sql()})
    third.Execute(sql);
  EXPECT_EQ(SchemaOf(folder / "3.db"), Contents(kStored / "schema_3.sql"));
  sessions::Database fourth = sessions::Database::Create(folder / "4.db");
  for (const std::string& sql :
       {sessions::Schema1Sql(), sessions::Schema2Sql(), sessions::Schema3Sql(), sessions::Schema4Sql()})
    fourth.Execute(sql);
  EXPECT_EQ(SchemaOf(folder / "4.db"), Contents(kStored / "schema_4.sql"));
  WriteSampleSession(folder / "5.db", 1);
  EXPECT_EQ(SchemaOf(folder / "5.db"), Contents(kStored / "schema_5.sql"));
}

TEST(Schema, AnEmptyDatabaseBecomesTheNewestSchemaAndMigratingAgainChangesNothing) {
  const TemporaryFolder folder;
  sessions::Database database = sessions::Database::Create(folder / "s.db");
  sessions::Migrate(database);
  EXPECT_EQ(database.ReadInteger("PRAGMA user_version"), sessions::kSchemaVersion);
  EXPECT_EQ(database.ReadInteger("PRAGMA application_id"), sessions::kApplicationId);
  const std::int64_t entries = database.ReadInteger("SELECT count(*) FROM sqlite_schema");
  EXPECT_GT(entries, 20);
  sessions::Migrate(database);
  EXPECT_EQ(database.ReadInteger("SELECT count(*) FROM sqlite_schema"), entries);
}

TEST(Schema, StoredSessionsOfEverySchemaAreRead) {
  for (const int schema : {1, 2, 3, 4, 5}) {
    SCOPED_TRACE(schema);
    const SessionReader reader(kStored / fmt::format("session_schema_{}.db", schema));
    ExpectEqual(reader.header(), AsOfSchema(schema, SampleHeader()));
    ASSERT_EQ(reader.frame_count(), 6);
    for (core::FrameIndex i = 0; i < 6; ++i) {
      ExpectEqual(reader.ReadFrame(i), AsOfSchema(schema, SampleFrame(reader.header(), i, 1)));
    }
    ASSERT_EQ(reader.episodes().size(), 2U);
    EXPECT_EQ(reader.episodes()[0].peak_position_in_part_mm.has_value(), schema >= 3);
    EXPECT_EQ(reader.near_misses().size(), schema >= 3 ? 1U : 0U);
    EXPECT_EQ(reader.heat_maps().size(), schema >= 3 ? 1U : 0U);
    EXPECT_EQ(reader.clearances().empty(), schema < 3);
    EXPECT_EQ(reader.events().size(), 4U);
  }
}

TEST(Schema, ADatabaseOfAnyOlderSchemaBecomesOneOfTheNewest) {
  for (const int schema : {1, 2, 3, 4}) {
    const TemporaryFolder folder;
    sessions::Database database = sessions::Database::Create(folder / "s.db");
    database.Execute(sessions::Schema1Sql());
    if (schema >= 2) database.Execute(sessions::Schema2Sql());
    if (schema >= 3) database.Execute(sessions::Schema3Sql());
    if (schema >= 4) database.Execute(sessions::Schema4Sql());
    database.Execute(fmt::format("PRAGMA user_version = {}", schema));
    sessions::Migrate(database);
    EXPECT_EQ(SchemaOf(folder / "s.db"), Contents(kStored / "schema_5.sql"));
  }
}

TEST(Schema, AnOlderSchemaIsMigratedInMemoryAndTheFileStays) {
  const TemporaryFolder folder;
  {
    SQLite::Database database((folder / "s.db").string(), SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
    database.exec("PRAGMA application_id = " + std::to_string(sessions::kApplicationId));
  }
  const std::string before = Contents(folder / "s.db");
  ExpectError([&] { SessionReader(folder / "s.db"); }, core::ErrorKind::kFormat, "it holds no set-up");
  EXPECT_EQ(Contents(folder / "s.db"), before);
}

TEST(Schema, ANewerSchemaIsNamed) {
  const TemporaryFolder folder;
  WriteSampleSession(folder / "s.db", 1);
  SQLite::Database((folder / "s.db").string(), SQLite::OPEN_READWRITE).exec("PRAGMA user_version = 6");
  ExpectError([&] { SessionReader(folder / "s.db"); }, core::ErrorKind::kFormat, "has schema 6");
}

TEST(Schema, CountsAndFlagsOutOfRangeAreRefusedByTheDatabaseItself) {
  const TemporaryFolder folder;
  WriteSampleSession(folder / "s.db", 2);
  SQLite::Database database((folder / "s.db").string(), SQLite::OPEN_READWRITE);
  database.exec("PRAGMA foreign_keys = ON");
  for (const char* sql :
       {"UPDATE part_frame SET verdict = 'perhaps'", "UPDATE session SET status = 'done'",
        "INSERT INTO frame VALUES (9, 'soon')", "DELETE FROM frame", "DELETE FROM mask",
        "UPDATE camera SET camera_matrix = '[1]'", "INSERT INTO session SELECT * FROM session",
        "UPDATE event SET to_mm = NULL WHERE kind = 'spacing'", "UPDATE clearance SET lower_mm = -1",
        "UPDATE clearance SET upper_mm = lower_mm - 1", "UPDATE near_miss SET verdict = 'contact'",
        "UPDATE episode SET tools = 'tongs'", "DELETE FROM clearance", "UPDATE pair_rule SET ignored = 2",
        "UPDATE stream SET direction = '[1]'", "UPDATE mesh SET deviation_mm = -1",
        "UPDATE part SET unit_of = 'layout'",
        "INSERT INTO part_motion VALUES (99, 0, '[1,0,0,0,1,0,0,0,1]', '[0,0,0]')",
        "INSERT INTO part_motion VALUES (0, 0, '[1]', '[0,0,0]')"}) {
    EXPECT_THROW(database.exec(sql), SQLite::Exception) << sql;
  }
}

}  // namespace
}  // namespace elbowroom::tests
