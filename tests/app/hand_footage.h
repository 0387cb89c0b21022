// Footage on disk of hands before cameras that run freely, one of which may be knocked.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "core/ids.h"
#include "tests/recon/consistency/moving_hands.h"

namespace elbowroom::test_support {

struct CameraKnock {
  core::CameraIndex camera = 0;
  double at_s = 0.0;
  double turn_px = 0.0;  // root mean square shift of the picture
};

struct HandFootage {
  std::vector<double> offset_s;  // one a camera: its picture with the stamp t shows the scene at t + this
  double seconds = 10.0;
  double rate_hz = 20.0;
  std::optional<CameraKnock> knock = std::nullopt;
  recon::testing::HandMotion motion = {};
};

// Writes rig.yml, and for each camera its ready masks and their stamps, below `folder`. The cameras' phases
// are all different. Returns the path of rig.yml.
std::filesystem::path WriteHandFootage(const std::filesystem::path& folder, const HandFootage& footage);

}  // namespace elbowroom::test_support
