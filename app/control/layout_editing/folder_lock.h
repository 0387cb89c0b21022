// One program at a time changes the files of a folder.
#pragma once

#include <filesystem>

namespace elbowroom::control {

// Holds the lock of the file's folder, and waits for other programs that hold it. A program that doesn't ask
// for the lock isn't held off. Where the folder can't be opened nothing is held: the next operation there
// says why.
// Throws: Error{kCancelled} when the wait is interrupted; Error{kFile} when another program holds it and
// nobody is to wait.
class FolderLock {
 public:
  enum class Waiting { kYes, kNo };

  explicit FolderLock(const std::filesystem::path& file, Waiting waiting = Waiting::kYes);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int folder_ = -1;  // a descriptor
};

}  // namespace elbowroom::control
