#include "recon/paper_methods/sweep_comparison.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <optional>
#include <vector>

#include "core/error.h"
#include "recon/paper_methods/coverage_hull.h"
#include "recon/paper_methods/plane_grid.h"

namespace elbowroom::recon {
namespace {

// Whether rounding decides a label at picture positions that come from a grid.
class GridRounding {
 public:
  GridRounding(const core::Rig& rig, std::span<const core::SoftMask> masks, const core::CameraModel& view,
               int cells)
      : cameras_(MakeSweepCameras(rig, masks, view.cam_from_world().Inverse())), grid_(view, cells) {}

  [[nodiscard]] bool Decides(int x, int y, float depth_mm) {
    std::vector<Positions>& positions = positions_[depth_mm];
    if (positions.empty())
      for (const SweepCamera& camera : cameras_) positions.push_back(grid_.PositionsOf(camera, depth_mm));
    const std::size_t triangle = grid_.TriangleOf(x, y);
    for (std::size_t i = 0; i < cameras_.size(); ++i) {
      const std::optional<GridTriangle>& of_camera = positions[i][triangle];
      const std::optional<Eigen::Vector2d> position = of_camera ? of_camera->At(x, y) : std::nullopt;
      if (position && IsMatterOfRounding(cameras_[i], *position)) return true;
    }
    return false;
  }

 private:
  using Positions = std::vector<std::optional<GridTriangle>>;

  std::vector<SweepCamera> cameras_;
  PlaneGrid grid_;
  std::map<float, std::vector<Positions>> positions_;  // by the plane's depth, one a camera
};

}  // namespace

SweepComparison CompareSweeps(const core::Rig& rig, std::span<const core::SoftMask> masks,
                              const core::CameraModel& view, const DepthMap& a, const DepthMap& b,
                              int undistortion_grid) {
  core::Require(a.depth_mm.size() == b.depth_mm.size() && a.width_px == b.width_px &&
                    a.width_px == view.width_px() && a.height_px == view.height_px(),
                "compared sweeps are of one view");
  const CoverageHull hull(rig, masks);
  std::optional<GridRounding> grid;
  if (undistortion_grid > 0) grid.emplace(rig, masks, view, undistortion_grid);
  const core::RigidTransform world_from_view = view.cam_from_world().Inverse();
  SweepComparison comparison;
  for (std::size_t i = 0; i < a.depth_mm.size(); ++i) {
    if (a.depth_mm[i] == b.depth_mm[i]) continue;
    ++comparison.differing_pixels;
    const auto x = static_cast<int>(i % static_cast<std::size_t>(a.width_px)),
               y = static_cast<int>(i / static_cast<std::size_t>(a.width_px));
    const auto ray = view.NormalisedFromPixel({static_cast<double>(x), static_cast<double>(y)});
    const auto [low, high] = std::minmax(a.depth_mm[i], b.depth_mm[i]);
    const float depth_mm = low == 0.0F ? high : low;
    const auto is_explained = [&] {
      if (!ray) return false;
      const Eigen::Vector3d x_in_world = world_from_view * (double{depth_mm} * ray->homogeneous());
      return grid ? hull.IsAtFace(x_in_world) || grid->Decides(x, y, depth_mm)
                  : hull.IsMatterOfRounding(x_in_world);
    };
    comparison.unexplained_pixels += is_explained() ? 0 : 1;
  }
  return comparison;
}

}  // namespace elbowroom::recon
