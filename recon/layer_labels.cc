// Compiled once for each kind of processor; see Highway's foreach_target.h.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "recon/layer_labels.cc"
#include <hwy/foreach_target.h>

#include <hwy/highway.h>

#include "recon/contour_map.h"
#include "recon/layer_labels.h"

HWY_BEFORE_NAMESPACE();
namespace elbowroom::recon::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using Doubles = hn::CappedTag<double, 8>;
using Ints = hn::Rebind<std::int32_t, Doubles>;
using VD = hn::Vec<Doubles>;
using VI = hn::Vec<Ints>;

HWY_INLINE unsigned BitsOf(VI label, std::int32_t bit) {
  std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(Ints(), hn::TestBit(label, hn::Set(Ints(), bit)), bytes);
  return bytes[0];
}

// The labels of the cells of as many points as a vector holds. No fused operation: it would round differently
// on processors without one.
HWY_INLINE VI LabelsOf(const PointLayer& points, const RasterView& raster, std::size_t first,
                       LayerAnswer* answer) {
  const Doubles d;
  const Ints n;
  const VD z = hn::Add(hn::Load(d, points.z + first), hn::Set(d, points.layer_z));
  const VD per_z = hn::Div(hn::Set(d, 1.0), z);
  const VD x = hn::Mul(hn::Add(hn::Load(d, points.x + first), hn::Set(d, points.layer_x)), per_z);
  const VD y = hn::Mul(hn::Add(hn::Load(d, points.y + first), hn::Set(d, points.layer_y)), per_z);
  hn::Store(x, d, answer->x_px + first);
  hn::Store(y, d, answer->y_px + first);
  const VD per_px = hn::Set(d, raster.cells_per_px), zero = hn::Zero(d);
  const VD across = hn::Mul(hn::Sub(x, hn::Set(d, raster.origin_x_px)), per_px);
  const VD down = hn::Mul(hn::Sub(y, hn::Set(d, raster.origin_y_px)), per_px);
  // Written so that a NaN is in no cell.
  const auto is_across = hn::And(hn::Ge(across, zero), hn::Lt(across, hn::Set(d, raster.width)));
  const auto is_down = hn::And(hn::Ge(down, zero), hn::Lt(down, hn::Set(d, raster.height)));
  const auto is_in_cell = hn::And(hn::And(is_across, is_down), hn::Gt(z, zero));
  const VI column = hn::DemoteTo(n, hn::IfThenElseZero(is_in_cell, across));
  const VI row = hn::DemoteTo(n, hn::IfThenElseZero(is_in_cell, down));
  const VI index = hn::Add(hn::Mul(row, hn::Set(n, raster.width)), column);
  return hn::GatherOffset(n, reinterpret_cast<const std::int32_t*>(raster.labels), index);
}

std::size_t Label(const PointLayer& points, const RasterView& raster, std::uint8_t* bits,
                  LayerAnswer* answer) {
  std::size_t looked_at = 0;
  for (std::size_t byte = 0; byte < kMostLayerBytes; ++byte) {
    answer->mixed[byte] = 0;
    if (bits[byte] == 0) continue;
    ++looked_at;
    unsigned object = 0, mixed = 0;
    for (std::size_t i = 0; i < 8; i += hn::Lanes(Doubles())) {
      const VI label = LabelsOf(points, raster, 8 * byte + i, answer);
      object |= BitsOf(label, LabelRaster::kObject) << i;
      mixed |= BitsOf(label, LabelRaster::kMixed) << i;
    }
    answer->mixed[byte] = static_cast<std::uint8_t>(bits[byte] & mixed);
    bits[byte] = static_cast<std::uint8_t>(bits[byte] & (object | mixed));
  }
  return looked_at;
}

}  // namespace
}  // namespace elbowroom::recon::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace elbowroom::recon {

HWY_EXPORT(Label);

std::size_t LabelLayer(const PointLayer& points, const RasterView& raster, std::uint8_t* bits,
                       LayerAnswer* answer) {
  return HWY_DYNAMIC_DISPATCH(Label)(points, raster, bits, answer);
}

}  // namespace elbowroom::recon
#endif
