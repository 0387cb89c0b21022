// Entries of a zip file, read and written for tests.
#pragma once

#include <filesystem>
#include <map>
#include <string>

namespace elbowroom::tests {

// By name. Throws: std::runtime_error.
[[nodiscard]] std::map<std::string, std::string> ZipEntries(const std::filesystem::path& path);
void WriteZip(const std::filesystem::path& path, const std::map<std::string, std::string>& entries);

}  // namespace elbowroom::tests
