#include "sessions/whole_files.h"

#include <fmt/format.h>

#include <fstream>
#include <string_view>
#include <vector>

#include "core/error.h"

namespace elbowroom::sessions {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void FailToWrite(const fs::path& path, std::string_view reason) {
  throw core::Error(core::ErrorKind::kFile,
                    fmt::format("can't write '{}'{}{}; choose a folder that can be written, on a "
                                "disk with room",
                                path.string(), reason.empty() ? "" : ": ", reason));
}

// Temporary files that go unless they were renamed.
class PendingFiles {
 public:
  PendingFiles() = default;
  PendingFiles(const PendingFiles&) = delete;
  PendingFiles& operator=(const PendingFiles&) = delete;
  ~PendingFiles() {
    std::error_code ignored;  // already reporting a failure, or nothing is left
    for (const Pending& file : files_) fs::remove(file.temporary, ignored);
  }

  void Write(const fs::path& target, const std::string& content) {
    fs::path temporary = target;
    temporary += ".part";
    files_.push_back({temporary, target});
    std::ofstream file(temporary, std::ios::binary | std::ios::trunc);
    file.write(content.data(), static_cast<std::streamsize>(content.size()));
    file.close();
    if (!file) FailToWrite(target, "");
  }

  void RenameAll() {
    for (const Pending& file : files_) {
      if (fs::is_directory(file.target)) FailToWrite(file.target, "it is a folder");
    }
    for (const Pending& file : files_) {
      std::error_code failure;
      fs::rename(file.temporary, file.target, failure);
      if (failure) FailToWrite(file.target, failure.message());
    }
  }

 private:
  struct Pending {
    fs::path temporary;
    fs::path target;
  };
  std::vector<Pending> files_;
};

}  // namespace

void WriteWholeFiles(const fs::path& folder, const std::map<std::string, std::string>& content_by_name) {
  std::error_code failure;
  fs::create_directories(folder, failure);
  if (!fs::is_directory(folder)) FailToWrite(folder, failure ? failure.message() : "it is not a folder");
  PendingFiles pending;
  for (const auto& [name, content] : content_by_name) pending.Write(folder / name, content);
  pending.RenameAll();
}

}  // namespace elbowroom::sessions
