// Whether two session files have the same rows of results.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace elbowroom::control {

// Rows of tables of the results, and of the silhouettes that they come from, that are in one file alone.
// `where`: which frames of the first.
[[nodiscard]] std::int64_t RowsThatDiffer(const std::filesystem::path& recorded,
                                          const std::filesystem::path& replayed,
                                          const std::string& where = "1");

}  // namespace elbowroom::control
