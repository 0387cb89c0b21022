// Files that appear whole or not at all.
#pragma once

#include <filesystem>
#include <functional>
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

  // All throw: Error{kFile} naming the path.
  void Write(const std::filesystem::path& path, std::string_view bytes);
  // The bytes that `produce` hands to its argument, piece by piece. What `produce` throws comes through.
  using Sink = std::function<void(std::string_view)>;
  void WriteInPieces(const std::filesystem::path& path, const std::function<void(const Sink&)>& produce);
  void RenameAll();

 private:
  struct Pending {
    std::filesystem::path temporary;
    std::filesystem::path path;
  };
  std::vector<Pending> files_;
};

}  // namespace elbowroom::core
