#include "recon/sweep_comparison.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "core/error.h"
#include "recon/coverage_texture.h"

namespace elbowroom::recon {
namespace {

constexpr double kPositionPx = 0.01;
constexpr double kBandLevels = 255.0 * (4.0 / 256.0 + 2.0 * kPositionPx);
constexpr double kBorderMm = 0.01;

// True if the camera's label at a point may come out either way.
bool IsClose(const core::CameraModel& camera, const CoverageTexture& coverage,
             const Eigen::Vector3d& x_in_world) {
  const auto pixel = camera.Project(x_in_world);
  if (!pixel) return false;
  const Eigen::Vector2d center(0.5 * (camera.width_px() - 1), 0.5 * (camera.height_px() - 1));
  const Eigen::Vector2d half(0.5 * camera.width_px(), 0.5 * camera.height_px());
  const double to_border_px = (half - (*pixel - center).cwiseAbs()).minCoeff();
  return std::abs(CoverageAt(coverage, *pixel) - 127.5) <= kBandLevels ||
         std::abs(to_border_px) <= kPositionPx;
}

}  // namespace

SweepComparison CompareSweeps(const core::Rig& rig, std::span<const core::SoftMask> masks,
                              const core::CameraModel& view, const DepthMap& a, const DepthMap& b) {
  core::Require(a.depth_mm.size() == b.depth_mm.size() && a.width_px == b.width_px &&
                    a.width_px == view.width_px() && a.height_px == view.height_px(),
                "compared sweeps are of one view");
  core::Require(masks.size() == rig.cameras.size(), "a plane sweep has one mask a camera");
  std::vector<CoverageTexture> coverages;
  for (const core::SoftMask& mask : masks) coverages.push_back(MakeCoverageTexture(mask));
  const core::RigidTransform world_from_view = view.cam_from_world().Inverse();
  SweepComparison comparison;
  for (std::size_t i = 0; i < a.depth_mm.size(); ++i) {
    if (a.depth_mm[i] == b.depth_mm[i]) continue;
    ++comparison.differing_pixels;
    const auto width = static_cast<std::size_t>(a.width_px);
    const auto ray =
        view.NormalisedFromPixel({static_cast<double>(i % width), static_cast<double>(i / width)});
    const auto [low, high] = std::minmax(a.depth_mm[i], b.depth_mm[i]);
    bool is_explained = false;
    if (ray) {
      const Eigen::Vector3d x_in_world =
          world_from_view * (double{low == 0.0F ? high : low} * ray->homogeneous());
      for (std::size_t c = 0; c < masks.size(); ++c)
        is_explained |= IsClose(rig.cameras[c], coverages[c], x_in_world);
      const Eigen::Vector3d to_face =
          (x_in_world - rig.workspace_mm.min()).cwiseMin(rig.workspace_mm.max() - x_in_world);
      is_explained |= std::abs(to_face.minCoeff()) <= kBorderMm;
    }
    comparison.unexplained_pixels += is_explained ? 0 : 1;
  }
  return comparison;
}

}  // namespace elbowroom::recon
