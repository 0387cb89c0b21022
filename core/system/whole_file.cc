#include "core/system/whole_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <set>

#include "core/error.h"
#include "core/system/file_sync.h"

namespace elbowroom::core {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void FailToWrite(const fs::path& path) {
  throw Error(ErrorKind::kFile, fmt::format("{}: can't be written; check that the folder exists, is writable "
                                            "and has room, and that the file is no folder and not protected",
                                            path.string()));
}

// Writes all of `bytes` and waits until they are on the disk. If a file were renamed before that, it could be
// empty after a power failure.
bool WriteToDisk(int file, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t size = ::write(file, bytes.data(), bytes.size());
    if (size < 0 && errno == EINTR) continue;
    if (size <= 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(size));
  }
  // A file that isn't on a disk, such as a pipe, can't be synced and needn't be.
  return ::fsync(file) == 0 || errno == EINVAL || errno == EROFS;
}

}  // namespace

PendingFiles::~PendingFiles() {
  std::error_code ignored;  // a failure is being reported already, or nothing is left
  for (const Pending& file : files_) fs::remove(file.temporary, ignored);
}

void PendingFiles::Write(const fs::path& path, std::string_view bytes) {
  std::error_code error;
  // A symbolic link stays; the file that it points to is replaced.
  const fs::path target = fs::is_symlink(path, error) ? fs::weakly_canonical(path, error) : path;
  const fs::file_status status = fs::status(target, error);
  const bool is_there = fs::exists(status);
  if (fs::is_directory(status) || (is_there && ::access(target.c_str(), W_OK) != 0)) FailToWrite(path);
  const fs::path temporary = fmt::format("{}.{}.part", target.string(), getpid());
  constexpr mode_t kAsTheUserLikes = 0666;
  const int file = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, kAsTheUserLikes);
  if (file < 0) FailToWrite(path);
  files_.push_back({temporary, target});
  const bool is_written = WriteToDisk(file, bytes);
  const bool is_closed = ::close(file) == 0;
  if (!is_written || !is_closed) FailToWrite(path);
  if (is_there) fs::permissions(temporary, status.permissions(), error);
}

void PendingFiles::RenameAll() {
  std::set<fs::path> folders;
  for (const Pending& file : files_) {
    std::error_code error;
    fs::rename(file.temporary, file.path, error);
    if (error) FailToWrite(file.path);
    folders.insert(FolderOf(file.path));
  }
  for (const fs::path& folder : folders) SyncFolder(folder);
}

void WriteWholeFile(const fs::path& path, std::string_view bytes) {
  PendingFiles file;
  file.Write(path, bytes);
  file.RenameAll();
}

}  // namespace elbowroom::core
