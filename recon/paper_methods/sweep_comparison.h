// Whether two sweeps of the same masks differ by more than rounding.
#pragma once

#include <cstdint>
#include <span>

#include "core/rig.h"
#include "core/soft_mask.h"
#include "recon/images/depth_map.h"

namespace elbowroom::recon {

struct SweepComparison {
  std::int64_t differing_pixels = 0;
  std::int64_t unexplained_pixels = 0;  // of those: no label there is a matter of rounding
};

// A difference is explained if rounding decides the label of the nearer surface's point: some camera's
// coverage there is within 4/256 and a few roundings of one half (docs/plane_sweep.md, "Rounding"), or the
// point is at the border of its picture or of the workspace. For rigs at ordinary distances: positions are
// taken to be good to 0.01 px. `undistortion_grid`: as PlaneSweepOptions', of both sweeps. Throws:
// PreconditionError when sizes differ.
[[nodiscard]] SweepComparison CompareSweeps(const core::Rig& rig, std::span<const core::SoftMask> masks,
                                            const core::CameraModel& view, const DepthMap& a,
                                            const DepthMap& b, int undistortion_grid = 0);

}  // namespace elbowroom::recon
