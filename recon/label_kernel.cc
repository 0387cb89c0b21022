// Compiled once for each kind of processor; see Highway's foreach_target.h.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "recon/label_kernel.cc"
#include <hwy/foreach_target.h>

#include <hwy/highway.h>

#include "recon/contour_map.h"
#include "recon/label_kernel.h"

HWY_BEFORE_NAMESPACE();
namespace elbowroom::recon::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using Doubles = hn::CappedTag<double, 8>;
using Ints = hn::Rebind<std::int32_t, Doubles>;
using VD = hn::Vec<Doubles>;
using VI = hn::Vec<Ints>;

constexpr std::size_t kSide = kBlockPoints;

// As many points as a vector holds.
struct Points {
  VD x;
  VD y;
  VD z;
};

HWY_INLINE VD Set(double number) { return hn::Set(Doubles(), number); }

// No fused operation anywhere: it would round differently on processors without one. The order of the sums is
// PointProjection::Block::At's.
HWY_INLINE Points Times(VD count, const std::array<double, 3>& step) {
  return {hn::Mul(count, Set(step[0])), hn::Mul(count, Set(step[1])), hn::Mul(count, Set(step[2]))};
}
HWY_INLINE Points Sum(const Points& a, const Points& b) {
  return {hn::Add(a.x, b.x), hn::Add(a.y, b.y), hn::Add(a.z, b.z)};
}
HWY_INLINE Points Spread(const std::array<double, 3>& point) {
  return {Set(point[0]), Set(point[1]), Set(point[2])};
}
// begin + count * step
HWY_INLINE std::array<double, 3> Along(const std::array<double, 3>& begin, double count,
                                       const std::array<double, 3>& step) {
  return {begin[0] + count * step[0], begin[1] + count * step[1], begin[2] + count * step[2]};
}

HWY_INLINE unsigned BitsOf(VI label, std::int32_t bit) {
  std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(Ints(), hn::TestBit(label, hn::Set(Ints(), bit)), bytes);
  return bytes[0];
}

class Labeller {
 public:
  Labeller(const RasterView& raster, BlockBits* bits, BlockBits* mixed)
      : raster_(raster), bits_(*bits), mixed_(*mixed) {}

  // Points `first` and on of a group.
  HWY_INLINE void Ask(std::size_t first, const Points& points) {
    const VI label = LabelsOf(points);
    object_ |= BitsOf(label, LabelRaster::kObject) << first;
    unsure_ |= BitsOf(label, LabelRaster::kMixed) << first;
  }
  HWY_INLINE void Finish(std::size_t group) {
    mixed_.groups[group] = static_cast<std::uint8_t>(bits_.groups[group] & unsure_);
    bits_.groups[group] = static_cast<std::uint8_t>(bits_.groups[group] & (object_ | unsure_));
    object_ = unsure_ = 0;
    ++asked_;
  }
  // False if nothing is to be asked.
  HWY_INLINE bool Begin(std::size_t group) {
    mixed_.groups[group] = 0;
    return bits_.groups[group] != 0;
  }
  [[nodiscard]] std::size_t asked() const { return asked_; }

 private:
  HWY_INLINE VI LabelsOf(const Points& points) const {
    const Doubles d;
    const Ints n;
    const VD per_z = hn::Div(Set(1.0), points.z), zero = hn::Zero(d);
    const VD x = hn::Mul(points.x, per_z), y = hn::Mul(points.y, per_z);
    const VD across = hn::Mul(hn::Sub(x, Set(raster_.origin_x_px)), Set(raster_.cells_per_px));
    const VD down = hn::Mul(hn::Sub(y, Set(raster_.origin_y_px)), Set(raster_.cells_per_px));
    // Written so that a NaN is in no cell.
    const auto is_across = hn::And(hn::Ge(across, zero), hn::Lt(across, Set(raster_.width)));
    const auto is_down = hn::And(hn::Ge(down, zero), hn::Lt(down, Set(raster_.height)));
    const auto is_in_cell = hn::And(hn::And(is_across, is_down), hn::Gt(points.z, zero));
    const VI column = hn::DemoteTo(n, hn::IfThenElseZero(is_in_cell, across));
    const VI row = hn::DemoteTo(n, hn::IfThenElseZero(is_in_cell, down));
    const VI index = hn::Add(hn::Mul(row, hn::Set(n, raster_.width)), column);
    return hn::GatherOffset(n, reinterpret_cast<const std::int32_t*>(raster_.labels), index);
  }

  const RasterView& raster_;
  BlockBits& bits_;
  BlockBits& mixed_;
  unsigned object_ = 0, unsure_ = 0;
  std::size_t asked_ = 0;
};

std::size_t Label(const BlockView& block, const RasterView& raster, BlockBits* bits, BlockBits* mixed) {
  const Doubles d;
  const std::size_t at_once = hn::Lanes(d);
  Labeller labeller(raster, bits, mixed);
  std::array<std::array<double, 3>, kSide> rows, layers;
  for (std::size_t i = 0; i < kSide; ++i) {
    rows[i] = Along({}, block.corner[1] + static_cast<double>(i), block.steps[1]);
    layers[i] = Along(block.origin, block.corner[2] + static_cast<double>(i), block.steps[2]);
  }
  for (std::size_t group = 0; group < BlockBits::kRows; ++group) {
    if (!labeller.Begin(group)) continue;
    for (std::size_t i = 0; i < 8; i += at_once) {
      const VD x = hn::Add(hn::Iota(d, static_cast<double>(i)), Set(block.corner[0]));
      const Points in_layer = Sum(Times(x, block.steps[0]), Spread(rows[group % kSide]));
      labeller.Ask(i, Sum(in_layer, Spread(layers[group / kSide])));
    }
    labeller.Finish(group);
  }
  // The far face.
  const Points across = Times(Set(block.corner[0] + kBlockCells), block.steps[0]);
  for (std::size_t group = BlockBits::kRows; group < BlockBits::kGroups; ++group) {
    if (!labeller.Begin(group)) continue;
    for (std::size_t i = 0; i < 8; i += at_once) {
      alignas(64) double y[8] = {}, z[8] = {};
      for (std::size_t lane = 0; lane < at_once; ++lane) {
        const std::size_t row = 8 * (group - BlockBits::kRows) + i + lane;
        y[lane] = block.corner[1] + static_cast<double>(row % kSide);
        z[lane] = block.corner[2] + static_cast<double>(row / kSide);
      }
      const Points in_layer = Sum(across, Times(hn::Load(d, y), block.steps[1]));
      labeller.Ask(i, Sum(in_layer, Sum(Spread(block.origin), Times(hn::Load(d, z), block.steps[2]))));
    }
    labeller.Finish(group);
  }
  return labeller.asked();
}

}  // namespace
}  // namespace elbowroom::recon::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace elbowroom::recon {

HWY_EXPORT(Label);

std::size_t LabelByCells(const BlockView& block, const RasterView& raster, BlockBits* bits,
                         BlockBits* mixed) {
  return HWY_DYNAMIC_DISPATCH(Label)(block, raster, bits, mixed);
}

}  // namespace elbowroom::recon
#endif
