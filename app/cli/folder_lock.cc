#include "app/cli/folder_lock.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>

#include "core/error.h"

namespace elbowroom::cli {

FolderLock::FolderLock(const std::filesystem::path& file) {
  namespace fs = std::filesystem;
  std::error_code error;
  // Absolute first: the canonical form of a bare name that isn't there yet has no folder.
  const fs::path folder = fs::weakly_canonical(fs::absolute(file, error), error).parent_path();
  folder_ = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder_ < 0) return;
  if (::flock(folder_, LOCK_EX) != 0 && errno == EINTR) {
    ::close(folder_);
    throw core::Error(
        core::ErrorKind::kCancelled,
        fmt::format("{}: the change was cancelled while another program changed it", file.string()));
  }
}

FolderLock::~FolderLock() {
  if (folder_ >= 0) ::close(folder_);
}

}  // namespace elbowroom::cli
