#include "recon/paper_methods/sweep_comparison.h"

#include <algorithm>
#include <cstddef>

#include "core/error.h"
#include "recon/paper_methods/coverage_hull.h"

namespace elbowroom::recon {
SweepComparison CompareSweeps(const core::Rig& rig, std::span<const core::SoftMask> masks,
                              const core::CameraModel& view, const DepthMap& a, const DepthMap& b) {
  core::Require(a.depth_mm.size() == b.depth_mm.size() && a.width_px == b.width_px &&
                    a.width_px == view.width_px() && a.height_px == view.height_px(),
                "compared sweeps are of one view");
  const CoverageHull hull(rig, masks);
  const core::RigidTransform world_from_view = view.cam_from_world().Inverse();
  SweepComparison comparison;
  for (std::size_t i = 0; i < a.depth_mm.size(); ++i) {
    if (a.depth_mm[i] == b.depth_mm[i]) continue;
    ++comparison.differing_pixels;
    const std::size_t row = i / static_cast<std::size_t>(a.width_px),
                      column = i % static_cast<std::size_t>(a.width_px);
    const auto ray = view.NormalisedFromPixel({static_cast<double>(column), static_cast<double>(row)});
    const auto [low, high] = std::minmax(a.depth_mm[i], b.depth_mm[i]);
    const bool is_explained =
        ray &&
        hull.IsMatterOfRounding(world_from_view * (double{low == 0.0F ? high : low} * ray->homogeneous()));
    comparison.unexplained_pixels += is_explained ? 0 : 1;
  }
  return comparison;
}

}  // namespace elbowroom::recon
