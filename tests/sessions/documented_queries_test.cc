#include <SQLiteCpp/SQLiteCpp.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/sessions/sample_session.h"
#include "tests/support/documented_queries.h"
#include "tests/support/temporary_folder.h"

namespace elbowroom::tests {
namespace {

using test_support::TemporaryFolder;

TEST(DocumentedQueries, EachRunsAndFindsSomething) {
  const TemporaryFolder folder;
  WriteSampleSession(folder / "s.db", 40);
  SQLite::Database database((folder / "s.db").string());
  const std::vector<std::string> blocks = test_support::DocumentedQueries();
  ASSERT_GE(blocks.size(), 8U);
  for (const std::string& sql : blocks) {
    try {
      SQLite::Statement statement(database, sql);
      EXPECT_TRUE(statement.executeStep()) << "no row from:\n" << sql;
    } catch (const SQLite::Exception& exception) {
      ADD_FAILURE() << exception.what() << " in:\n" << sql;
    }
  }
}

}  // namespace
}  // namespace elbowroom::tests
