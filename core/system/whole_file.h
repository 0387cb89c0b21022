// Files that appear whole or not at all.
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

namespace elbowroom::core {

// Writes a temporary beside `path`, brings it to the disk and renames it to `path`. A failure leaves no
// temporary behind; a power failure leaves the old file or the new one. If `path` is a symbolic link, the
// file that it points to is replaced. The new file has the permissions of the old one; a file without write
// permission is not replaced. Throws: Error{kFile} naming the path.
void WriteWholeFile(const std::filesystem::path& path, std::string_view bytes);

// Several files, all of them written as temporaries before the first is renamed. The destructor removes the
// temporaries that weren't renamed.
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
