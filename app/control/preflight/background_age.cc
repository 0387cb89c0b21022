#include "app/control/preflight/background_age.h"

#include <algorithm>
#include <system_error>

#include "recon/rig_files/source_location.h"

namespace elbowroom::control {
namespace {

namespace fs = std::filesystem;

// The file, or of several the one that was written last; nothing: none is there.
std::optional<fs::file_time_type> WrittenAt(const std::string& location) {
  const recon::SourceKind kind = recon::KindOf(location);
  fs::path folder = location;
  if (kind == recon::SourceKind::kSequence || kind == recon::SourceKind::kGlob) folder = folder.parent_path();
  std::error_code failure;
  if (!fs::is_directory(folder, failure)) {
    const fs::file_time_type at = fs::last_write_time(location, failure);
    return failure ? std::nullopt : std::optional(at);
  }
  std::optional<fs::file_time_type> newest;
  for (fs::directory_iterator entry(folder, failure), end; !failure && entry != end;
       entry.increment(failure)) {
    std::error_code unreadable;
    if (!recon::HasImageExtension(entry->path())) continue;
    const fs::file_time_type at = entry->last_write_time(unreadable);
    if (!unreadable) newest = std::max(newest.value_or(at), at);
  }
  return newest;
}

}  // namespace

BackgroundFiles FindBackgroundFiles(const recon::RigFile& rig_file) {
  BackgroundFiles files;
  for (std::size_t i = 0; i < rig_file.sources.size(); ++i) {
    const recon::CameraSources& sources = rig_file.sources[i];
    if (!sources.masks.empty()) continue;
    const auto at = sources.background.empty() ? std::nullopt : WrittenAt(sources.background);
    if (at) {
      files.written_at = std::min(files.written_at.value_or(*at), *at);
    } else if (files.lacking_camera.empty()) {
      files.lacking_camera = rig_file.rig.cameras[i].name();
    }
  }
  return files;
}

}  // namespace elbowroom::control
