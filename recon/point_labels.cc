#include "recon/point_labels.h"

#include <bit>
#include <cstddef>

namespace elbowroom::recon {
PointProjection::PointProjection(const core::CameraModel& camera, double focal_px, const HullGrid& grid) {
  const Eigen::Vector3d scale(focal_px, focal_px, 1.0);
  const core::RigidTransform& cam_from_world = camera.cam_from_world();
  const Eigen::Vector3d origin = scale.cwiseProduct(cam_from_world * grid.origin_in_world);
  const Eigen::Matrix3d steps = scale.asDiagonal() * cam_from_world.rotation * grid.edge_mm;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    origin_[i] = origin[row];
    for (std::size_t axis = 0; axis < 3; ++axis)
      steps_[axis][i] = steps(row, static_cast<Eigen::Index>(axis));
  }
}

PointProjection::Block::Block(const PointProjection& projection, const GridPoint& corner) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t i = 0; i < kBlockPoints; ++i) {
      const double steps = corner[static_cast<Eigen::Index>(axis)] + static_cast<double>(i);
      for (std::size_t k = 0; k < 3; ++k) {
        along_[axis][i][k] = steps * projection.steps_[axis][k];
        if (axis == 2) along_[axis][i][k] = projection.origin_[k] + along_[axis][i][k];
      }
    }
  }
}

std::int64_t PointProjection::KeepByCells(const LabelRaster& raster, const GridPoint& corner, BlockBits* bits,
                                          BlockBits* mixed) const {
  const BlockView block{
      origin_,
      steps_,
      {static_cast<double>(corner.x()), static_cast<double>(corner.y()), static_cast<double>(corner.z())}};
  const RasterView view{raster.labels.data(), raster.origin_px.x(), raster.origin_px.y(),
                        1.0 / raster.cell_px, raster.cells.x(),     raster.cells.y()};
  return static_cast<std::int64_t>(8 * LabelByCells(block, view, bits, mixed));
}

void PointProjection::SettleMixed(const ContourMap& labels, const GridPoint& corner, const BlockBits& mixed,
                                  BlockBits* bits) const {
  const Block points(*this, corner);
  for (std::size_t group = 0; group < mixed.groups.size(); ++group) {
    std::uint8_t& kept = bits->groups[group];
    for (unsigned left = mixed.groups[group] & kept; left != 0; left &= left - 1) {
      const auto bit = static_cast<std::size_t>(std::countr_zero(left));
      const auto [x, y, z] = BlockBits::PointOf(group, bit);
      if (labels.IsObject(points.At(x, y, z).position)) continue;
      kept = static_cast<std::uint8_t>(kept & ~(1U << bit));
    }
  }
}

}  // namespace elbowroom::recon
