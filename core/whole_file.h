// Files that appear whole or not at all.
#pragma once

#include <filesystem>
#include <string_view>

namespace elbowroom::core {

// Writes a temporary beside `path` and renames it over `path`; nothing is left behind on failure.
// Throws: Error{kFile} naming the path.
void WriteWholeFile(const std::filesystem::path& path, std::string_view bytes);

}  // namespace elbowroom::core
