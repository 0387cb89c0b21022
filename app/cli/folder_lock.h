// One program at a time changes the files of a folder.
#pragma once

#include <filesystem>

namespace elbowroom::cli {

// Waits for others that hold the lock of the file's folder; they and this are programs that ask for it. Where
// the folder can't be opened nothing is held: whatever is done there next says why.
// Throws: Error{kCancelled} when the wait is interrupted.
class FolderLock {
 public:
  explicit FolderLock(const std::filesystem::path& file);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int folder_ = -1;  // a descriptor
};

}  // namespace elbowroom::cli
