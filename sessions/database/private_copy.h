// A session's files, copied to where they may be written: recovery after a crash may have to write before the
// session can be read.
#pragma once

#include <filesystem>

namespace elbowroom::sessions {

// A copy in a temporary folder of its own, which is removed with this object.
class PrivateCopy {
 public:
  // Copies the database, its log, its rollback journal and its spill, as far as they exist. Throws:
  // Error{kFile} naming the session and the folder when they can't be copied.
  explicit PrivateCopy(std::filesystem::path original);
  ~PrivateCopy();
  PrivateCopy(const PrivateCopy&) = delete;
  PrivateCopy& operator=(const PrivateCopy&) = delete;

  [[nodiscard]] const std::filesystem::path& original() const { return original_; }
  [[nodiscard]] std::filesystem::path path() const { return folder_ / original_.filename(); }

 private:
  void CopyFile(const std::filesystem::path& from) const;

  std::filesystem::path original_, folder_;
};

}  // namespace elbowroom::sessions
