#include "core/whole_file.h"

#include <fmt/format.h>
#include <unistd.h>

#include <fstream>

#include "core/error.h"

namespace elbowroom::core {
namespace {

[[noreturn]] void FailToWrite(const std::filesystem::path& path) {
  throw Error(ErrorKind::kFile,
              fmt::format("{}: can't be written; check that the folder exists, is writable and has room",
                          path.string()));
}

}  // namespace

PendingFiles::~PendingFiles() {
  std::error_code ignored;  // a failure is being reported already, or nothing is left
  for (const Pending& file : files_) std::filesystem::remove(file.temporary, ignored);
}

void PendingFiles::Write(const std::filesystem::path& path, std::string_view bytes) {
  const std::filesystem::path temporary = fmt::format("{}.{}.part", path.string(), getpid());
  files_.push_back({temporary, path});
  std::ofstream file(temporary, std::ios::binary | std::ios::trunc);
  file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  file.close();
  if (!file || std::filesystem::is_directory(path)) FailToWrite(path);
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
