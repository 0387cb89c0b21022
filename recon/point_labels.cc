#include "recon/point_labels.h"

#include <array>
#include <bit>
#include <cstddef>

namespace elbowroom::recon {
namespace {

// Points that wait for their labels, and whose bits they are.
class Waiting {
 public:
  Waiting(const GridView& grid, const LabelRaster& raster, BlockBits* bits)
      : grid_(grid), raster_(raster), bits_(*bits) {}

  void Add(std::size_t group, std::size_t bit, const GridPoint& corner) {
    const std::array<std::size_t, 3> in_block = BlockBits::PointOf(group, bit);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      points_.at[axis][points_.count] =
          corner[static_cast<Eigen::Index>(axis)] + static_cast<double>(in_block[axis]);
    }
    bits_of_points_[points_.count] = {static_cast<std::uint8_t>(group), static_cast<std::uint8_t>(1U << bit)};
    if (++points_.count == GridPoints::kMost) Settle();
  }

  void Settle() {
    const std::uint64_t object = LabelPoints(grid_, raster_, points_);
    for (std::size_t i = 0; i < points_.count; ++i) {
      const auto [group, bit] = bits_of_points_[i];
      const unsigned clear = (object >> i & 1U) != 0 ? 0U : bit;
      bits_.groups[group] = static_cast<std::uint8_t>(bits_.groups[group] & ~clear);
    }
    points_.count = 0;
  }

 private:
  struct BitOfPoint {
    std::uint8_t group, bit;
  };
  static_assert(BlockBits::kGroups <= 256);

  const GridView& grid_;
  const LabelRaster& raster_;
  BlockBits& bits_;
  GridPoints points_;
  std::array<BitOfPoint, GridPoints::kMost> bits_of_points_{};
};

}  // namespace

GridView ViewGrid(const core::CameraModel& camera, double focal_px, const HullGrid& grid) {
  const Eigen::Vector3d scale(focal_px, focal_px, 1.0);
  const core::RigidTransform& cam_from_world = camera.cam_from_world();
  const Eigen::Vector3d origin = scale.cwiseProduct(cam_from_world * grid.origin_in_world);
  const Eigen::Matrix3d steps = scale.asDiagonal() * cam_from_world.rotation * grid.edge_mm;
  GridView view;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    view.origin[i] = origin[row];
    for (std::size_t axis = 0; axis < 3; ++axis)
      view.steps[axis][i] = steps(row, static_cast<Eigen::Index>(axis));
  }
  return view;
}

void SettleMixed(const GridView& grid, const LabelRaster& raster, const GridPoint& corner,
                 const BlockBits& mixed, BlockBits* bits) {
  Waiting waiting(grid, raster, bits);
  for (std::size_t group = 0; group < mixed.groups.size(); ++group) {
    for (unsigned left = mixed.groups[group] & bits->groups[group]; left != 0; left &= left - 1)
      waiting.Add(group, static_cast<std::size_t>(std::countr_zero(left)), corner);
  }
  waiting.Settle();
}

}  // namespace elbowroom::recon
