#include "sessions/report/whole_files.h"

#include "core/system/file_sync.h"
#include "core/system/whole_file.h"

namespace elbowroom::sessions {

void WriteWholeFiles(const std::filesystem::path& folder,
                     const std::map<std::string, std::string>& content_by_name) {
  core::MakeFolder(folder);
  core::PendingFiles pending;
  for (const auto& [name, content] : content_by_name) pending.Write(folder / name, content);
  pending.RenameAll();
}

}  // namespace elbowroom::sessions
