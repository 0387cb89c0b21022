#include "recon/point_labels.h"

#include <bit>
#include <cstddef>

namespace elbowroom::recon {
namespace {

// Labels the points in mixed cells, one by one.
void Settle(const ContourMap& labels, const MixedPoints& mixed, BlockBits* bits) {
  for (std::size_t group = 0; group < mixed.groups.size(); ++group) {
    for (unsigned left = mixed.groups[group]; left != 0; left &= left - 1) {
      const std::size_t i = 8 * group + static_cast<std::size_t>(std::countr_zero(left));
      if (labels.IsObject({mixed.x_px[i], mixed.y_px[i]})) continue;
      bits->groups[group] = static_cast<std::uint8_t>(bits->groups[group] & ~(left & -left));
    }
  }
}

}  // namespace

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

std::int64_t PointProjection::KeepObject(const ContourMap& labels, const LabelRaster& raster,
                                         const GridPoint& corner, BlockBits* bits) const {
  const BlockView block{
      origin_,
      steps_,
      {static_cast<double>(corner.x()), static_cast<double>(corner.y()), static_cast<double>(corner.z())}};
  const RasterView view{raster.labels.data(), raster.origin_px.x(), raster.origin_px.y(),
                        1.0 / raster.cell_px, raster.cells.x(),     raster.cells.y()};
  MixedPoints mixed;
  const std::size_t asked = LabelByCells(block, view, bits, &mixed);
  Settle(labels, mixed, bits);
  return static_cast<std::int64_t>(8 * asked);
}

}  // namespace elbowroom::recon
