#include "core/whole_file.h"

#include <fmt/format.h>
#include <unistd.h>

#include <fstream>

#include "core/error.h"

namespace elbowroom::core {
namespace {

[[noreturn]] void FailToWrite(const std::filesystem::path& path) {
  throw Error(ErrorKind::kFile, fmt::format("{}: can't be written; check that the folder exists, is writable "
                                            "and has room, and that the file is no folder and not protected",
                                            path.string()));
}

}  // namespace

PendingFiles::~PendingFiles() {
  std::error_code ignored;  // a failure is being reported already, or nothing is left
  for (const Pending& file : files_) std::filesystem::remove(file.temporary, ignored);
}

void PendingFiles::Write(const std::filesystem::path& path, std::string_view bytes) {
  namespace fs = std::filesystem;
  std::error_code error;
  // What a link points to, not the link.
  const fs::path target = fs::is_symlink(path, error) ? fs::weakly_canonical(path, error) : path;
  const fs::file_status status = fs::status(target, error);
  const bool is_there = fs::exists(status);
  if (fs::is_directory(status) || (is_there && ::access(target.c_str(), W_OK) != 0)) FailToWrite(path);
  const fs::path temporary = fmt::format("{}.{}.part", target.string(), getpid());
  files_.push_back({temporary, target});
  std::ofstream file(temporary, std::ios::binary | std::ios::trunc);
  file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  file.close();
  if (!file) FailToWrite(path);
  if (is_there) fs::permissions(temporary, status.permissions(), error);
}

void PendingFiles::RenameAll() {
  for (const Pending& file : files_) {
    std::error_code error;
    std::filesystem::rename(file.temporary, file.path, error);
    if (error) FailToWrite(file.path);
  }
}

void WriteWholeFile(const std::filesystem::path& path, std::string_view bytes) {
  PendingFiles file;
  file.Write(path, bytes);
  file.RenameAll();
}

}  // namespace elbowroom::core
