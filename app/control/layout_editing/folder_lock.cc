#include "app/control/layout_editing/folder_lock.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>

#include "core/error.h"

namespace elbowroom::control {

FolderLock::FolderLock(const std::filesystem::path& file, Waiting waiting) {
  namespace fs = std::filesystem;
  std::error_code error;
  // Absolute first: the canonical form of a bare name that isn't there yet has no folder.
  const fs::path folder = fs::weakly_canonical(fs::absolute(file, error), error).parent_path();
  folder_ = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder_ < 0) return;
  const bool is_held = ::flock(folder_, LOCK_EX | (waiting == Waiting::kNo ? LOCK_NB : 0)) == 0;
  const int failure = is_held ? 0 : errno;
  if (failure == EWOULDBLOCK) {
    ::close(folder_);
    throw core::Error(core::ErrorKind::kFile,
                      fmt::format("{}: another program is changing layouts of this folder; try again when it "
                                  "is done",
                                  file.string()));
  }
  if (failure == EINTR) {
    ::close(folder_);
    throw core::Error(
        core::ErrorKind::kCancelled,
        fmt::format("{}: the change was cancelled while another program changed it", file.string()));
  }
}

FolderLock::~FolderLock() {
  if (folder_ >= 0) ::close(folder_);
}

}  // namespace elbowroom::control
