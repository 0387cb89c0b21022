#include "sessions/archive/table_rows.h"

#include <SQLiteCpp/SQLiteCpp.h>
#include <fmt/format.h>
#include <sqlite3.h>

#include <utility>

#include "sessions/database/statement.h"
#include "sessions/schema/schema.h"
#include "sessions/schema/schema_check.h"

namespace elbowroom::sessions {

RawStatement::RawStatement(Database& database, const std::string& sql) : database_(database) {
  if (sqlite3_prepare_v2(database.connection().getHandle(), sql.c_str(), -1, &statement_, nullptr) !=
      SQLITE_OK)
    Fail();
}

RawStatement::~RawStatement() { sqlite3_finalize(statement_); }

bool RawStatement::Next() {
  const int code = sqlite3_step(statement_);
  if (code != SQLITE_ROW && code != SQLITE_DONE) Fail();
  return code == SQLITE_ROW;
}

void RawStatement::Reset() { sqlite3_reset(statement_); }

void RawStatement::Fail() const {
  try {
    throw SQLite::Exception(database_.connection().getHandle());
  } catch (const SQLite::Exception&) {
    RethrowAsError(database_.path());
  }
}

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
  RawStatement rows(database, fmt::format("SELECT * FROM \"{}\"", table));
  while (rows.Next()) visit(rows.get());
}

}  // namespace elbowroom::sessions
