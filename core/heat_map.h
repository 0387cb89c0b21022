// Where on a part it was touched: for how long, how deep.
#pragma once

#include <vector>

#include "core/ids.h"

namespace elbowroom::core {

// Longest side of a patch of SurfacePatches, unless a triangle needs more pieces than it is cut into.
inline constexpr double kHeatPatchMm = 10.0;

struct HeatMap {
  PartIndex part = 0;
  double patch_mm = kHeatPatchMm;
  // One a patch of SurfacePatches(the part's mesh, patch_mm).
  std::vector<float> dwell_s;
  std::vector<float> peak_depth_mm;  // certified lower bound; 0 where never touched
};

}  // namespace elbowroom::core
