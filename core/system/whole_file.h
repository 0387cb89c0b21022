// Files that appear whole or not at all.
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

namespace elbowroom::core {

// Writes a temporary beside `path`, brings it to the disk and renames it over `path`; nothing is left behind
// on failure, and a power failure leaves the old file or the new one. Of a symbolic link, over what it points
// to; a file that was there keeps its permissions, and one that may not be written stays what it is. Throws:
// Error{kFile} naming the path.
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
