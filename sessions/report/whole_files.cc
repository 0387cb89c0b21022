#include "sessions/report/whole_files.h"

#include "core/system/file_sync.h"
#include "core/system/whole_file.h"

namespace elbowroom::sessions {

std::vector<std::filesystem::path> WriteWholeFiles(
    const std::filesystem::path& folder, const std::map<std::string, std::string>& content_by_name) {
  core::MakeFolder(folder);
  core::PendingFiles pending;
  std::vector<std::filesystem::path> files;
  for (const auto& [name, content] : content_by_name) {
    files.push_back(folder / name);
    pending.Write(files.back(), content);
  }
  pending.RenameAll();
  return files;
}

}  // namespace elbowroom::sessions
