#include "tests/support/documented_queries.h"
#include "tests/support/places.h"

#include <filesystem>
#include <fstream>

namespace elbowroom::test_support {

std::vector<std::string> DocumentedQueries() {
  std::vector<std::string> blocks;
  bool is_inside = false;
  std::ifstream file(test_support::SourceFolder() / "docs/session_database.md");
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

}  // namespace elbowroom::test_support
