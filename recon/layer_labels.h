// The inner loop of labelling grid points: vectors of any processor. See point_labels.h.
#pragma once

#include <cstddef>
#include <cstdint>

namespace elbowroom::recon {

// Points in bytes of eight, as their bits are.
inline constexpr std::size_t kMostLayerBytes = 11;
inline constexpr std::size_t kMostLayerPoints = 8 * kMostLayerBytes;

// A layer of points before a camera; each point's place is the sum of its own and the layer's. x and y are
// times the focal length, and all of it in mm.
struct PointLayer {
  alignas(64) double x[kMostLayerPoints];
  alignas(64) double y[kMostLayerPoints];
  alignas(64) double z[kMostLayerPoints];
  double layer_x = 0.0;
  double layer_y = 0.0;
  double layer_z = 0.0;
};

// LabelRaster, as the loop wants it.
struct RasterView {
  const std::uint8_t* labels = nullptr;
  double origin_x_px = 0.0;
  double origin_y_px = 0.0;
  double cells_per_px = 1.0;
  std::int32_t width = 0;
  std::int32_t height = 0;
};

struct LayerAnswer {
  // In the picture plane, of the points of the bytes that were looked at.
  alignas(64) double x_px[kMostLayerPoints];
  alignas(64) double y_px[kMostLayerPoints];
  std::uint8_t mixed[kMostLayerBytes];  // bits of the points in mixed cells
};

// Clears the bits of points that are in cells of background, or in none and cell 0 is; leaves those in mixed
// ones. Bytes of zeros are skipped; returns how many weren't.
std::size_t LabelLayer(const PointLayer& points, const RasterView& raster, std::uint8_t* bits,
                       LayerAnswer* answer);

}  // namespace elbowroom::recon
