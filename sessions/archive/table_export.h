// The tables and views of a session as CSV and JSON files.
#pragma once

#include <cstdint>
#include <filesystem>
#include <stop_token>
#include <string>
#include <vector>

#include "core/progress.h"

namespace elbowroom::sessions {

struct ExportedTable {
  std::string name;  // of a table or view of the newest schema
  std::int64_t rows = 0;
};

// Writes NAME.csv (a line of column names, then a line a row; NULL is an empty field; texts as Quoted() gives
// them) and NAME.json (an array of one object a row, values as they are) for each of `tables`, or for all
// tables and views where `tables` is empty. Bytes are in base64. The folder is made if need be; all files or
// none. Rows are never all in memory. Throws: Error{kRange} for a name that the schema doesn't have;
// Error{kFile}; what SessionReader throws when it opens a file; Error{kCancelled}.
[[nodiscard]] std::vector<ExportedTable> ExportTables(const std::filesystem::path& session,
                                                      std::vector<std::string> tables,
                                                      const std::filesystem::path& folder,
                                                      const core::Progress& progress,
                                                      const std::stop_token& stop);

}  // namespace elbowroom::sessions
