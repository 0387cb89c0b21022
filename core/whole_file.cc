#include "core/whole_file.h"

#include <fmt/format.h>
#include <unistd.h>

#include <fstream>

#include "core/error.h"

namespace elbowroom::core {

void WriteWholeFile(const std::filesystem::path& path, std::string_view bytes) {
  const std::filesystem::path temporary = fmt::format("{}.{}.part", path.string(), getpid());
  std::ofstream file(temporary, std::ios::binary | std::ios::trunc);
  file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  file.close();
  std::error_code error;
  if (file) std::filesystem::rename(temporary, path, error);
  if (!file || error) {
    std::error_code ignored;
    std::filesystem::remove(temporary, ignored);
    throw core::Error(
        core::ErrorKind::kFile,
        fmt::format("{}: can't be written; check that the folder exists, is writable and has room",
                    path.string()));
  }
}

}  // namespace elbowroom::core
