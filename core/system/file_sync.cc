#include "core/system/file_sync.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <vector>

#include "core/error.h"

namespace elbowroom::core {

namespace fs = std::filesystem;

void SyncFolder(const fs::path& folder) noexcept {
  const int number = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (number < 0) return;
  (void)!::fsync(number);
  ::close(number);
}

fs::path FolderOf(const fs::path& path) { return path.has_parent_path() ? path.parent_path() : "."; }

void MakeFolder(const fs::path& folder) {
  std::error_code failure;
  std::vector<fs::path> made;
  for (fs::path missing = folder; !missing.empty() && !fs::exists(missing, failure);
       missing = missing.parent_path()) {
    made.push_back(missing);
    if (missing == missing.parent_path()) break;
  }
  fs::create_directories(folder, failure);
  if (!fs::is_directory(folder)) {
    throw Error(ErrorKind::kFile,
                fmt::format("{}: can't be made: {}; choose a folder that can be written", folder.string(),
                            failure ? failure.message() : "it is not a folder"));
  }
  for (const fs::path& one : made) SyncFolder(FolderOf(one));
}

}  // namespace elbowroom::core
