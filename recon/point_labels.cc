#include "recon/point_labels.h"

#include <bit>

#include "recon/layer_labels.h"

namespace elbowroom::recon {
namespace {

using Eigen::Vector3d;

static_assert(BlockBits::kLayerBytes == kMostLayerBytes);

// Labels the points in mixed cells, one by one.
void SettleMixed(const ContourMap& labels, const LayerAnswer& answer, BlockBits::Layer* bits) {
  for (std::size_t byte = 0; byte < bits->size(); ++byte) {
    for (unsigned mixed = answer.mixed[byte]; mixed != 0; mixed &= mixed - 1) {
      const std::size_t i = 8 * byte + static_cast<std::size_t>(std::countr_zero(mixed));
      const bool is_object = labels.IsObject({answer.x_px[i], answer.y_px[i]});
      if (!is_object) (*bits)[byte] = static_cast<std::uint8_t>((*bits)[byte] & ~(mixed & -mixed));
    }
  }
}

}  // namespace

PointProjection::PointProjection(const core::CameraModel& camera, double focal_px, const HullGrid& grid) {
  const Vector3d scale(focal_px, focal_px, 1.0);
  const core::RigidTransform& cam_from_world = camera.cam_from_world();
  origin_ = scale.cwiseProduct(cam_from_world * grid.origin_in_world);
  for (std::size_t axis = 0; axis < 3; ++axis)
    steps_[axis] =
        scale.cwiseProduct(cam_from_world.rotation.col(static_cast<Eigen::Index>(axis)) * grid.edge_mm);
}

PointProjection::Point PointProjection::Of(const GridPoint& p) const {
  const Vector3d in_layer = p.x() * steps_[0] + p.y() * steps_[1];
  const Vector3d layer = origin_ + p.z() * steps_[2];
  const Vector3d in_cam = in_layer + layer;
  return {in_cam.head<2>() * (1.0 / in_cam.z()), in_cam.z()};
}

std::int64_t PointProjection::KeepObject(const ContourMap& labels, const LabelRaster& raster,
                                         const GridPoint& corner, BlockBits* bits) const {
  PointLayer points;
  for (int i = 0; i < static_cast<int>(kMostLayerPoints); ++i) {
    const int x = corner.x() + i % kBlockPoints, y = corner.y() + i / kBlockPoints;
    const Vector3d in_layer = x * steps_[0] + y * steps_[1];
    points.x[i] = in_layer.x(), points.y[i] = in_layer.y(), points.z[i] = in_layer.z();
  }
  const RasterView view{raster.labels.data(), raster.origin_px.x(), raster.origin_px.y(),
                        1.0 / raster.cell_px, raster.cells.x(),     raster.cells.y()};
  LayerAnswer answer;
  std::size_t bytes = 0;
  for (int z = 0; z < kBlockPoints; ++z) {
    const Vector3d layer = origin_ + (corner.z() + z) * steps_[2];
    points.layer_x = layer.x(), points.layer_y = layer.y(), points.layer_z = layer.z();
    BlockBits::Layer& layer_bits = bits->layers[static_cast<std::size_t>(z)];
    bytes += LabelLayer(points, view, layer_bits.data(), &answer);
    SettleMixed(labels, answer, &layer_bits);
  }
  return static_cast<std::int64_t>(8 * bytes);
}

}  // namespace elbowroom::recon
