// Any table or view of a session, row by row.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "sessions/database/database.h"

struct sqlite3_stmt;

namespace elbowroom::sessions {

// The tables of the newest schema, then its views.
[[nodiscard]] std::vector<std::string> TablesAndViews();

// The names of a table's or view's columns, in order.
[[nodiscard]] std::vector<std::string> ColumnsOf(Database& database, const std::string& table);

// The statement stands on a row of all columns; SQLite's C functions read them.
using RawRowVisitor = std::function<void(sqlite3_stmt* row)>;

// In the order of the primary key, or of the view. Throws: DatabaseError; Error{kFormat} where it takes too
// long, Error{kCancelled}.
void VisitRows(Database& database, const std::string& table, const RawRowVisitor& visit);

}  // namespace elbowroom::sessions
