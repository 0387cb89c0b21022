// Files that appear whole or not at all.
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

namespace elbowroom::core {

// Writes a temporary beside `path` and renames it over `path`; nothing is left behind on failure.
// Throws: Error{kFile} naming the path.
void WriteWholeFile(const std::filesystem::path& path, std::string_view bytes);

// Several files that appear together: all are written as temporaries before the first is renamed, and those
// that weren't go with this object.
class PendingFiles {
 public:
  PendingFiles() = default;
  ~PendingFiles();
  PendingFiles(const PendingFiles&) = delete;
  PendingFiles& operator=(const PendingFiles&) = delete;

  // Both throw: Error{kFile} naming the path.
  void Write(const std::filesystem::path& path, std::string_view bytes);
  void RenameAll();

 private:
  struct Pending {
    std::filesystem::path temporary;
    std::filesystem::path path;
  };
  std::vector<Pending> files_;
};

}  // namespace elbowroom::core
