#include "app/control/cameras/light_check.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "core/error.h"
#include "recon/footage/background_reader.h"

namespace elbowroom::control {

LightCheck::LightCheck(const recon::RigFile& rig_file, const core::Progress& progress,
                       const std::stop_token& stop) {
  const auto can_be_watched = [](const recon::CameraSources& sources) {
    return sources.masks.empty() && !sources.background.empty();
  };
  if (!std::ranges::all_of(rig_file.sources, can_be_watched)) return;
  try {
    const auto backgrounds = recon::ReadBackgroundReferences(rig_file, progress, stop);
    for (core::CameraIndex i = 0; i < backgrounds.size(); ++i) {
      const core::CameraModel& camera = rig_file.rig.cameras[i];
      cameras_.push_back({recon::LightWatch(camera.name(), backgrounds[i], false),
                          core::BitMask(camera.width_px(), camera.height_px()),
                          {}});
    }
  } catch (const core::Error& error) {
    if (error.kind() == core::ErrorKind::kCancelled) throw;
    trouble_ = error.what();
    cameras_.clear();
  }
}

void LightCheck::Keep(core::CameraIndex camera, const recon::CapturedPicture& picture) {
  if (cameras_.empty()) return;
  constexpr std::size_t kMostHeld = 64;
  const std::lock_guard lock(mutex_);
  std::vector<recon::CapturedPicture>& held = cameras_[camera].held;
  if (held.size() < kMostHeld) held.push_back(picture);
}

void LightCheck::Forget() {
  const std::lock_guard lock(mutex_);
  for (Camera& camera : cameras_) camera.held.clear();
}

void LightCheck::Look() {
  for (Camera& camera : cameras_) {
    std::vector<recon::CapturedPicture> held;
    {
      const std::lock_guard lock(mutex_);
      held = std::exchange(camera.held, {});
    }
    for (const recon::CapturedPicture& picture : held) {
      const std::chrono::duration<double> time_s = picture.taken_at.time_since_epoch();
      camera.watch.Add(picture.image_bgr, camera.no_object, time_s.count());
      camera.has_looked = true;
    }
  }
}

std::optional<recon::LightReport> LightCheck::Report(core::CameraIndex camera) const {
  if (cameras_.empty() || !cameras_[camera].has_looked) return std::nullopt;
  return cameras_[camera].watch.Report();
}

}  // namespace elbowroom::control
