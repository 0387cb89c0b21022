#include "sessions/archive/table_rows.h"

#include <SQLiteCpp/SQLiteCpp.h>
#include <fmt/format.h>

#include <utility>

#include "sessions/database/statement.h"
#include "sessions/schema/schema.h"
#include "sessions/schema/schema_check.h"

namespace elbowroom::sessions {

std::vector<std::string> TablesAndViews() {
  std::vector<std::string> names = TablesOfSchema(kSchemaVersion);
  for (std::string& view : ViewsOfSchema(kSchemaVersion)) names.push_back(std::move(view));
  return names;
}

std::vector<std::string> ColumnsOf(Database& database, const std::string& table) {
  Statement rows(database, "SELECT name FROM pragma_table_info(?) ORDER BY cid");
  rows.With(table);
  std::vector<std::string> columns;
  while (rows.Next()) columns.push_back(rows.Text(0));
  return columns;
}

void VisitRows(Database& database, const std::string& table, const RawRowVisitor& visit) {
  try {
    SQLite::Statement rows(database.connection(), fmt::format("SELECT * FROM \"{}\"", table));
    while (rows.executeStep()) visit(rows.getPreparedStatement());
  } catch (const SQLite::Exception&) {
    RethrowAsError(database.path());
  }
}

}  // namespace elbowroom::sessions
