#include "core/system/whole_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <set>
#include <utility>

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

bool WriteAll(int file, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t size = ::write(file, bytes.data(), bytes.size());
    if (size < 0 && errno == EINTR) continue;
    if (size <= 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(size));
  }
  return true;
}

// Waits until what was written is on the disk. If a file were renamed before that, it could be empty after a
// power failure. A file that isn't on a disk, such as a pipe, can't be synced and needn't be.
bool SyncToDisk(int file) { return ::fsync(file) == 0 || errno == EINVAL || errno == EROFS; }

constexpr std::size_t kBytesAWrite = 1 << 20;

}  // namespace

PendingFile::PendingFile(const fs::path& path) : path_(path) {
  std::error_code error;
  // A symbolic link stays; the file that it points to is replaced.
  target_ = fs::is_symlink(path, error) ? fs::weakly_canonical(path, error) : path;
  const fs::file_status status = fs::status(target_, error);
  const bool is_there = fs::exists(status);
  if (fs::is_directory(status) || (is_there && ::access(target_.c_str(), W_OK) != 0)) FailToWrite(path);
  const fs::path temporary = fmt::format("{}.{}.part", target_.string(), getpid());
  constexpr mode_t kAsTheUserLikes = 0666;
  file_ = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, kAsTheUserLikes);
  if (file_ < 0) FailToWrite(path);
  temporary_ = temporary;
  if (is_there) fs::permissions(temporary, status.permissions(), error);
}

PendingFile::~PendingFile() {
  if (file_ >= 0) ::close(file_);
  std::error_code ignored;  // a failure is being reported already
  if (!temporary_.empty()) fs::remove(temporary_, ignored);
}

void PendingFile::Append(std::string_view bytes) {
  Require(file_ >= 0, "a file that was closed takes nothing more");
  if (waiting_.size() + bytes.size() < kBytesAWrite) {
    waiting_ += bytes;
    return;
  }
  WriteOut();
  if (!WriteAll(file_, bytes)) FailToWrite(path_);
}

void PendingFile::WriteOut() {
  if (!WriteAll(file_, waiting_)) FailToWrite(path_);
  waiting_.clear();
}

void PendingFile::Close() {
  if (file_ < 0) return;
  WriteOut();
  const bool is_synced = SyncToDisk(file_);
  if (::close(std::exchange(file_, -1)) != 0 || !is_synced) FailToWrite(path_);
}

void PendingFile::Rename() {
  Require(file_ < 0, "a file is closed before it gets its name");
  std::error_code error;
  fs::rename(temporary_, target_, error);
  if (error) FailToWrite(path_);
  temporary_.clear();
}

void PendingFiles::Write(const fs::path& path, std::string_view bytes) {
  PendingFile& file = Begin(path);
  file.Append(bytes);
  file.Close();
}

PendingFile& PendingFiles::Begin(const fs::path& path) {
  return *files_.emplace_back(std::make_unique<PendingFile>(path));
}

void PendingFiles::RenameAll() {
  for (const auto& file : files_) file->Close();
  std::set<fs::path> folders;
  for (const auto& file : files_) {
    file->Rename();
    folders.insert(FolderOf(file->target()));
  }
  for (const fs::path& folder : folders) SyncFolder(folder);
}

void WriteWholeFile(const fs::path& path, std::string_view bytes) {
  PendingFiles file;
  file.Write(path, bytes);
  file.RenameAll();
}

}  // namespace elbowroom::core
