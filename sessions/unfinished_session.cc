#include "sessions/unfinished_session.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "core/error.h"
#include "core/system/file_sync.h"
#include "sessions/database/database.h"
#include "sessions/database/session_files.h"

namespace elbowroom::sessions {
namespace {

[[noreturn]] void FailAsTaken(const std::filesystem::path& path) {
  throw core::Error(core::ErrorKind::kFile,
                    fmt::format("session '{}' exists already; choose another name", path.string()));
}

}  // namespace

UnfinishedSession::UnfinishedSession(std::filesystem::path path)
    : path_(std::move(path)), temporary_(WithSuffix(path_, fmt::format(".{}.part", ::getpid()))) {
  std::error_code ignored;
  if (std::filesystem::exists(std::filesystem::symlink_status(path_, ignored))) FailAsTaken(path_);
  const std::filesystem::path folder = core::FolderOf(path_);
  if (!std::filesystem::is_directory(folder, ignored))
    throw core::Error(
        core::ErrorKind::kFile,
        fmt::format("session '{}': there is no folder '{}'; make it first", path_.string(), folder.string()));
  RemoveDatabaseFiles(temporary_);
}

UnfinishedSession::~UnfinishedSession() {
  if (!is_in_place_) RemoveDatabaseFiles(temporary_);
}

void UnfinishedSession::PutInPlace() {
  // Unlike a rename, a link never replaces a file.
  if (::link(temporary_.c_str(), path_.c_str()) != 0) {
    const int failure = errno;
    if (failure == EEXIST) FailAsTaken(path_);
    std::error_code renaming;
    if (failure == EPERM || failure == EOPNOTSUPP) std::filesystem::rename(temporary_, path_, renaming);
    if (renaming || (failure != EPERM && failure != EOPNOTSUPP))
      throw core::Error(core::ErrorKind::kFile,
                        fmt::format("session '{}' can't be written: {}; make its folder writable",
                                    path_.string(), std::strerror(failure)));
  }
  is_in_place_ = true;
  RemoveDatabaseFiles(temporary_);
  core::SyncFolder(core::FolderOf(path_));
}

}  // namespace elbowroom::sessions
