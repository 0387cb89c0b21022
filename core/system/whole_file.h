// Files that appear whole or not at all.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace elbowroom::core {

// Writes a temporary beside `path`, brings it to the disk and renames it to `path`. A failure leaves no
// temporary behind; a power failure leaves the old file or the new one. If `path` is a symbolic link, the
// file that it points to is replaced. The new file has the permissions of the old one; a file without write
// permission is not replaced. Throws: Error{kFile} naming the path.
void WriteWholeFile(const std::filesystem::path& path, std::string_view bytes);

// A file of any length, written piece by piece as a temporary. Every member throws Error{kFile} naming the
// path. The destructor removes the temporary unless it was renamed.
class PendingFile {
 public:
  explicit PendingFile(const std::filesystem::path& path);
  ~PendingFile();
  PendingFile(const PendingFile&) = delete;
  PendingFile& operator=(const PendingFile&) = delete;

  void Append(std::string_view bytes);
  void Close();   // all that was appended is on the disk; nothing more can be appended
  void Rename();  // after Close()
  [[nodiscard]] const std::filesystem::path& target() const { return target_; }

 private:
  void WriteOut();

  std::filesystem::path path_;       // as given, for messages
  std::filesystem::path target_;     // where a symbolic link points to
  std::filesystem::path temporary_;  // empty: there is none any more
  std::string waiting_;              // for a larger write
  int file_ = -1;                    // -1: closed
};

// Several files, all of them written as temporaries before the first is renamed. The destructor removes the
// temporaries that weren't renamed. Every member throws Error{kFile} naming the path.
class PendingFiles {
 public:
  void Write(const std::filesystem::path& path, std::string_view bytes);
  // To be written piece by piece; lives as long as this does.
  [[nodiscard]] PendingFile& Begin(const std::filesystem::path& path);
  void RenameAll();  // closes those that are still open, first

 private:
  std::vector<std::unique_ptr<PendingFile>> files_;
};

}  // namespace elbowroom::core
