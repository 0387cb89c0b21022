// The demo's hand before a rig, as the benchmarks of views take it.
#pragma once

#include <vector>

#include "core/rig.h"
#include "core/soft_mask.h"

namespace elbowroom::benchmarks {

struct HandScene {
  core::Rig rig;
  std::vector<core::SoftMask> masks;  // ready ones
  core::CameraModel view;             // 640 x 480 without distortion; the hand fills about 6 % of it
};

// `cameras`: the first 3 or all of recon::FourCameraRig, or 8: recon::EightCameraRig.
[[nodiscard]] HandScene MakeHandScene(int cameras);

}  // namespace elbowroom::benchmarks
