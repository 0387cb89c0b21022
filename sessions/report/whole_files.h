// Files written whole or not at all.
#pragma once

#include <filesystem>
#include <map>
#include <string>

namespace elbowroom::sessions {

// Writes every content under its name in `folder`, which is made if need be: all under temporary names first,
// then renamed, so that a failure leaves what was there before.
// Throws: Error{kFile} naming what can't be written.
void WriteWholeFiles(const std::filesystem::path& folder,
                     const std::map<std::string, std::string>& content_by_name);

}  // namespace elbowroom::sessions
