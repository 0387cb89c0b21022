// A folder of its own for one test.
#pragma once

#include <filesystem>

namespace elbowroom::test_support {

// Made empty, removed with all that is in it.
class TemporaryFolder {
 public:
  // Throws: std::system_error when the system's temporary folder takes no more.
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] std::filesystem::path operator/(const std::filesystem::path& name) const {
    return path_ / name;
  }

 private:
  std::filesystem::path path_;
};

}  // namespace elbowroom::test_support
