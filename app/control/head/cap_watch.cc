#include "app/control/head/cap_watch.h"

#include "core/error.h"

namespace elbowroom::control {

CapWatch::CapWatch(const recon::Cap& cap, const core::Rig& rig) : finder_(cap) {
  for (const core::CameraModel& camera : rig.cameras) cameras_.emplace_back(camera);
}

std::variant<recon::CapPose, recon::NoCapPose> CapWatch::Find(const recon::FrameSet& frames) const {
  core::Require(frames.cameras.size() == cameras_.size(), "the pictures are those of the rig");
  std::vector<recon::CapSighting> sightings;
  for (const recon::CameraFrame& camera : frames.cameras)
    sightings.push_back(camera.image_bgr.empty() ? recon::CapSighting() : finder_.Find(camera.image_bgr));
  return recon::FindCapPose(finder_.cap(), cameras_, sightings);
}

}  // namespace elbowroom::control
