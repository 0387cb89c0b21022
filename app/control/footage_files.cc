#include "app/control/footage_files.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"
#include "core/system/file_hash.h"
#include "core/system/file_sync.h"

namespace elbowroom::control {

std::vector<core::FootageFile> FootageFilesIn(const std::filesystem::path& folder,
                                              const core::Progress& progress) {
  const std::filesystem::path above = core::FolderOf(folder);
  std::vector<core::FootageFile> files;
  try {
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
      if (!entry.is_regular_file()) continue;
      progress.Report(std::ssize(files) + 1, 0, "checksums of the footage, file");
      const std::string name = entry.path().lexically_relative(above).string();
      files.push_back({name, static_cast<std::int64_t>(entry.file_size()), core::HashOfFile(entry.path())});
    }
  } catch (const std::filesystem::filesystem_error& error) {
    throw core::Error(core::ErrorKind::kFile,
                      fmt::format("footage '{}': {}", folder.string(), error.code().message()));
  }
  std::ranges::sort(files, {}, [&](const core::FootageFile& file) {
    return std::pair(above / file.file != folder / "RIG.yml", file.file);
  });
  return files;
}

}  // namespace elbowroom::control
