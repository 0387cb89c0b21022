// Files written whole or not at all.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace elbowroom::sessions {

// Writes every content under its name in `folder`, which is made if need be: all under temporary names first,
// then renamed, so that a failure leaves what was there before.
// Returns: their paths, in the order of the names. Throws: Error{kFile} naming what can't be written.
std::vector<std::filesystem::path> WriteWholeFiles(const std::filesystem::path& folder,
                                                   const std::map<std::string, std::string>& content_by_name);

}  // namespace elbowroom::sessions
