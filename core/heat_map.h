// Where a part was touched, for how long and how deep.
#pragma once

#include <vector>

#include "core/ids.h"

namespace elbowroom::core {

// Longest side of a patch of SurfacePatches. A side is longer only where kMostHalvings halvings are too few.
inline constexpr double kHeatPatchMm = 10.0;

struct HeatMap {
  PartIndex part = 0;
  double patch_mm = kHeatPatchMm;
  // One value for each patch of SurfacePatches(the part's mesh, patch_mm).
  std::vector<float> dwell_s;
  std::vector<float> peak_depth_mm;  // certified lower bound; 0 where never touched
};

}  // namespace elbowroom::core
