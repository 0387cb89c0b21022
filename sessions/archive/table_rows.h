// Any table or view of a session, row by row.
#pragma once

#include <cstdint>
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

// A prepared statement for SQLite's C functions, which bind and read values of any type. Throws:
// DatabaseError.
class RawStatement {
 public:
  RawStatement(Database& database, const std::string& sql);
  ~RawStatement();
  RawStatement(const RawStatement&) = delete;
  RawStatement& operator=(const RawStatement&) = delete;

  [[nodiscard]] sqlite3_stmt* get() const { return statement_; }
  [[nodiscard]] bool Next();  // true while there is a row
  void Reset();

 private:
  [[noreturn]] void Fail() const;

  Database& database_;
  sqlite3_stmt* statement_ = nullptr;
};

// Rows between two reports of progress.
inline constexpr std::int64_t kRowsAReport = 1000;

// The statement stands on a row of all columns.
using RawRowVisitor = std::function<void(sqlite3_stmt* row)>;

// In the order of the primary key, or of the view. Throws: DatabaseError; Error{kFormat} where it takes too
// long, Error{kCancelled}.
void VisitRows(Database& database, const std::string& table, const RawRowVisitor& visit);

}  // namespace elbowroom::sessions
