// Whether a file's tables and views are those that its schema has.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sessions/database/database.h"

namespace elbowroom::sessions {

// The tables, or views, of a schema, in the order in which they were made. Throws: PreconditionError for a
// schema that this program doesn't know.
[[nodiscard]] std::vector<std::string> TablesOfSchema(std::int64_t schema);
[[nodiscard]] std::vector<std::string> ViewsOfSchema(std::int64_t schema);

// Every table, index and view of the schema must be there, with the SQL that the schema gave it. Entries of
// other names may be there as well, except a trigger on a table of the schema, and an index of expressions.
// Throws: Error{kFormat} naming the first entry for which this doesn't hold.
void RequireTablesOfSchema(Database& database, std::int64_t schema);

// Drops every entry that isn't the schema's, so that none can be in the way of a migration.
void DropAllButTablesOfSchema(Database& copy, std::int64_t schema);

}  // namespace elbowroom::sessions
