// Whether a file's tables and views are those that its schema has.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sessions/database.h"

namespace elbowroom::sessions {

// The tables of a schema, in the order in which they were made. Throws: PreconditionError for a schema that
// this program doesn't know.
[[nodiscard]] std::vector<std::string> TablesOfSchema(std::int64_t schema);

// Tables, indices and views are to be there, each by the SQL that the schema gave it; what has another name
// may be there as well, but no trigger on a table of the schema, and no index of expressions.
// Throws: Error{kFormat} naming the first that isn't so.
void RequireTablesOfSchema(Database& database, std::int64_t schema);

// Takes away what isn't the schema's, so that a migration meets nothing that it doesn't know.
void DropAllButTablesOfSchema(Database& copy, std::int64_t schema);

}  // namespace elbowroom::sessions
