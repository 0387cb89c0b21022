#include "sessions/whole_files.h"

#include <fmt/format.h>

#include "core/error.h"
#include "core/whole_file.h"

namespace elbowroom::sessions {

void WriteWholeFiles(const std::filesystem::path& folder,
                     const std::map<std::string, std::string>& content_by_name) {
  std::error_code failure;
  std::filesystem::create_directories(folder, failure);
  if (!std::filesystem::is_directory(folder)) {
    throw core::Error(core::ErrorKind::kFile,
                      fmt::format("can't write '{}': {}; choose a folder that can be written",
                                  folder.string(), failure ? failure.message() : "it is not a folder"));
  }
  core::PendingFiles pending;
  for (const auto& [name, content] : content_by_name) pending.Write(folder / name, content);
  pending.RenameAll();
}

}  // namespace elbowroom::sessions
