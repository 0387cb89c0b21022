#include <SQLiteCpp/SQLiteCpp.h>
#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <vector>

#include "tests/sessions/sample_session.h"
#include "tests/support/temporary_folder.h"

namespace elbowroom::tests {
namespace {

using test_support::TemporaryFolder;

// The text of every ```sql block of a Markdown file.
std::vector<std::string> SqlBlocksOf(const std::filesystem::path& path) {
  std::vector<std::string> blocks;
  bool is_inside = false;
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    if (line == "```sql") {
      is_inside = true;
      blocks.emplace_back();
    } else if (line == "```") {
      is_inside = false;
    } else if (is_inside) {
      blocks.back() += line + "\n";
    }
  }
  return blocks;
}

TEST(DocumentedQueries, EachRunsAndFindsSomething) {
  const TemporaryFolder folder;
  WriteSampleSession(folder / "s.db", 40);
  SQLite::Database database((folder / "s.db").string());
  const std::vector<std::string> blocks =
      SqlBlocksOf(std::filesystem::path(ELBOWROOM_SOURCE_DIR) / "docs/session_database.md");
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
