// A session file that appears under its name only when it is complete.
#pragma once

#include <filesystem>

namespace elbowroom::sessions {

// For sessions that can be made again, such as replays. A trial writes its file under its own name at once.
class UnfinishedSession {
 public:
  // Throws: core::Error{kFile} when `path` exists, or its folder doesn't.
  explicit UnfinishedSession(std::filesystem::path path);
  // Removes the temporary, unless it was put in place.
  ~UnfinishedSession();
  UnfinishedSession(const UnfinishedSession&) = delete;
  UnfinishedSession& operator=(const UnfinishedSession&) = delete;

  // Beside `path`; of no other program, and not there yet.
  [[nodiscard]] const std::filesystem::path& temporary() const { return temporary_; }

  // Gives the finished temporary its name, on the disk. Throws: core::Error{kFile} when there is a file of
  // that name by now, or it can't be done.
  void PutInPlace();

 private:
  std::filesystem::path path_;
  std::filesystem::path temporary_;
  bool is_in_place_ = false;
};

}  // namespace elbowroom::sessions
