#include "tests/recon/scenes/grid_oracle.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace elbowroom::recon {

using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

constexpr double kAnywhere = std::numeric_limits<double>::infinity();

// By the definition: the picture goes on beyond the lens's domain with the magnification at its rim.
Vector3d PlaceOf(const core::CameraModel& camera, const Vector3d& x) {
  const double tangent = x.head<2>().norm() / x.z();
  if (x.z() > 0.0 && tangent <= camera.max_radius())
    return x.z() * camera.PixelFromNormalised(x.head<2>() / x.z()).homogeneous();
  const Vector2d center = camera.PixelFromNormalised(Vector2d::Zero()),
                 rim = camera.PixelFromNormalised(camera.max_radius() * x.head<2>().normalized());
  const double times_as_far = x.head<2>().norm() / camera.max_radius();
  return (Vector3d() << x.z() * center + times_as_far * (rim - center), x.z()).finished();
}

}  // namespace

GridOracle::GridOracle(const core::CameraModel& view, int cells)
    : view_(view), cells_(cells), cell_px_(Vector2d(view.width_px(), view.height_px()) / cells) {
  for (int row = 0; row <= cells; ++row)
    for (int column = 0; column <= cells; ++column)
      node_rays_.push_back(
          view.NormalisedFromPixel(Vector2d(column, row).cwiseProduct(cell_px_) - Vector2d::Constant(0.5)));
}

GridOracle::Half GridOracle::HalfAt(const Vector2d& pixel) const {
  const Vector2d in_cells = (pixel + Vector2d::Constant(0.5)).cwiseQuotient(cell_px_);
  const double column = std::floor(in_cells.x()), row = std::floor(in_cells.y());
  return {static_cast<int>(column), static_cast<int>(row), in_cells.x() - column + in_cells.y() - row < 1.0};
}

std::optional<PicturePosition> GridOracle::PositionIn(const Half& half, const core::CameraModel& camera,
                                                      const Vector2d& pixel, double depth_mm,
                                                      const GridRoundings& rounded) const {
  const auto corner = [&](int right, int below) -> std::optional<Vector3d> {
    const auto node = static_cast<std::size_t>((half.row + below) * (cells_ + 1) + half.column + right);
    if (!node_rays_[node]) return std::nullopt;
    const Vector3d x_in_view = depth_mm * node_rays_[node]->homogeneous();
    return PlaceOf(camera, camera.cam_from_world() * (view_.cam_from_world().Inverse() * x_in_view));
  };
  const auto a = half.is_upper_left ? corner(0, 0) : corner(1, 1), b = corner(1, 0), c = corner(0, 1);
  if (!a || !b || !c) return std::nullopt;
  // The shares of b (right of a, or above it) and of c (below a, or left of it) at the pixel.
  const Vector2d in_cell =
      (pixel + Vector2d::Constant(0.5)).cwiseQuotient(cell_px_) - Vector2d(half.column, half.row);
  const double share_b = half.is_upper_left ? in_cell.x() : 1.0 - in_cell.y(),
               share_c = half.is_upper_left ? in_cell.y() : 1.0 - in_cell.x();
  const Vector3d place = (1.0 - share_b - share_c) * *a + share_b * *b + share_c * *c;
  // Numbers as large as a corner's go into it; and where a corner is moved, it moves with it.
  constexpr double kUnit = 0x1p-24;
  const Vector3d size = a->cwiseAbs().cwiseMax(b->cwiseAbs()).cwiseMax(c->cwiseAbs());
  const Vector3d along = (*b - *a).cwiseAbs() + (*c - *a).cwiseAbs();
  const Vector3d error = rounded.roundings * kUnit * size + rounded.corner_px / cell_px_.minCoeff() * along;
  if (place.z() < -error.z()) return std::nullopt;
  if (place.z() <= error.z()) return PicturePosition{Vector2d::Zero(), kAnywhere};
  const Vector2d px = place.hnormalized();
  return PicturePosition{px, (error.head<2>().norm() + px.norm() * error.z()) / (place.z() - error.z())};
}

std::vector<std::optional<PicturePosition>> GridOracle::PositionsOf(const core::CameraModel& camera, int x,
                                                                    int y, double depth_mm,
                                                                    const GridRoundings& rounded) const {
  constexpr double kNearEdgePx = 1.0 / 64.0;  // a centre nearer than this to an edge may be on either side
  std::vector<Half> halves;
  std::vector<std::optional<PicturePosition>> positions;
  for (const Vector2d& aside : {Vector2d(-1, -1), Vector2d(-1, 1), Vector2d(1, -1), Vector2d(1, 1)}) {
    const Vector2d pixel(x, y);
    const Half half = HalfAt(pixel + kNearEdgePx * aside);
    if (std::ranges::find(halves, half) != halves.end()) continue;
    halves.push_back(half);
    positions.push_back(PositionIn(half, camera, pixel, depth_mm, rounded));
  }
  return positions;
}

}  // namespace elbowroom::recon
