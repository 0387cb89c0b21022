#include "app/control/replay/session_footage.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <system_error>
#include <utility>

#include "core/error.h"
#include "core/system/file_hash.h"
#include "sessions/archive/footage_check.h"

namespace elbowroom::control {
namespace {

namespace fs = std::filesystem;
using core::Error;
using core::ErrorKind;

bool IsSameCamera(const core::CameraCalibration& one, const core::CameraCalibration& other) {
  return one.image_width_px == other.image_width_px && one.image_height_px == other.image_height_px &&
         one.camera_matrix == other.camera_matrix && one.distortion_model == other.distortion_model &&
         one.distortion_coefficients == other.distortion_coefficients &&
         one.cam_from_world == other.cam_from_world;
}

// The sources of the recorded cameras, in their order.
std::vector<recon::CameraSources> SourcesOf(const sessions::SessionReader& recorded, const fs::path& file,
                                            const recon::RigFile& rig_file) {
  std::vector<recon::CameraSources> sources;
  for (const core::CameraModel& camera : recorded.header().rig.cameras) {
    const auto& cameras = rig_file.rig.cameras;
    const auto same = std::ranges::find(cameras, camera.name(), &core::CameraModel::name);
    if (same == cameras.end())
      throw Error(
          ErrorKind::kFormat,
          fmt::format("rig '{}' has no camera '{}', which session '{}' has; give one with its cameras",
                      file.string(), camera.name(), recorded.path().string()));
    if (!IsSameCamera(same->calibration(), camera.calibration()))
      throw Error(
          ErrorKind::kFormat,
          fmt::format("rig '{}': the place, lens or picture size of camera '{}' isn't that of session "
                      "'{}'; give one of the same calibration",
                      file.string(), camera.name(), recorded.path().string()));
    sources.push_back(rig_file.sources[static_cast<std::size_t>(same - cameras.begin())]);
  }
  return sources;
}

// The RIG.yml that plays the footage, once all of its files are those that were recorded.
fs::path CheckedFootage(const sessions::SessionReader& recorded, const std::vector<core::FootageFile>& files,
                        const core::Progress& progress, const std::stop_token& stop) {
  const fs::path rig = sessions::FootagePath(recorded.path(), files.front());
  if (rig.filename() != "RIG.yml")
    throw Error(
        ErrorKind::kFormat,
        fmt::format("session '{}': the footage of a camera wasn't recorded whole, so no RIG.yml plays "
                    "it, and nothing can be segmented; replay it without --segment",
                    recorded.path().string()));
  std::int64_t done = 0;
  for (const core::FootageFile& file : files) {
    progress.Report(++done, std::ssize(files), "checking footage, file");
    if (const auto problem = sessions::FootageProblem(recorded.path(), file, stop))
      throw Error(ErrorKind::kFile, *problem + ", or replay it without --segment");
  }
  return rig;
}

bool HasSameContent(const fs::path& one, const fs::path& other, const std::stop_token& stop) {
  std::error_code ignored;
  if (!fs::is_regular_file(one, ignored) || !fs::is_regular_file(other, ignored)) return false;
  return core::HashOfFile(one, stop) == core::HashOfFile(other, stop);
}

// Backgrounds of a folder or pattern stay where they are when footage is recorded.
void WarnOfBackgroundsElsewhere(SessionFootage* footage) {
  const fs::path folder = footage->location.parent_path();
  for (core::CameraIndex i = 0; i < footage->rig_file.sources.size(); ++i) {
    const fs::path background = footage->rig_file.sources[i].background;
    if (background.empty() || *background.lexically_relative(folder).begin() != "..") continue;
    footage->warnings.push_back(fmt::format(
        "camera '{}': its background '{}' isn't among the footage, so nothing tells whether it is the "
        "recording's",
        footage->rig_file.rig.cameras[i].name(), background.string()));
  }
}

// Puts in the backgrounds that the rig names.
void TakeBackgrounds(const fs::path& rig, const std::vector<recon::CameraSources>& sources,
                     const std::stop_token& stop, SessionFootage* footage) {
  bool has_any = false;
  for (core::CameraIndex i = 0; i < sources.size(); ++i) {
    if (sources[i].background.empty()) continue;
    has_any = true;
    std::string& background = footage->rig_file.sources[i].background;
    if (!HasSameContent(background, sources[i].background, stop))
      footage->new_backgrounds.push_back(fmt::format(
          "camera '{}': background '{}'", footage->rig_file.rig.cameras[i].name(), sources[i].background));
    background = sources[i].background;
  }
  if (!has_any)
    throw Error(ErrorKind::kFormat,
                fmt::format("rig '{}' names no background; add one for each camera that needs another one",
                            rig.string()));
}

}  // namespace

SessionFootage FindFootage(const sessions::SessionReader& recorded, const fs::path& rig,
                           const core::Progress& progress, const std::stop_token& stop) {
  const std::vector<core::FootageFile> files = recorded.footage();
  if (files.empty() && rig.empty())
    throw Error(ErrorKind::kFormat,
                fmt::format("session '{}' names no footage to segment; give the RIG.yml whose footage was "
                            "judged with --rig, or record trials with record = \"footage\"",
                            recorded.path().string()));
  // What is wrong with the rig that was given is told before long files are read.
  std::vector<recon::CameraSources> given;
  if (!rig.empty()) given = SourcesOf(recorded, rig, recon::ReadRigFile(rig));
  SessionFootage footage;
  footage.is_named = !files.empty();
  const fs::path location = footage.is_named ? CheckedFootage(recorded, files, progress, stop) : rig;
  footage.location = fs::absolute(location).lexically_normal();
  footage.rig_file.rig = recorded.header().rig;
  if (!footage.is_named) {
    footage.rig_file.sources = std::move(given);
    return footage;
  }
  footage.rig_file.sources = SourcesOf(recorded, footage.location, recon::ReadRigFile(footage.location));
  if (rig.empty()) {
    WarnOfBackgroundsElsewhere(&footage);
  } else {
    TakeBackgrounds(rig, given, stop, &footage);
  }
  return footage;
}

}  // namespace elbowroom::control
