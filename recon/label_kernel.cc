// Compiled once for each kind of processor; see Highway's foreach_target.h.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "recon/label_kernel.cc"
#include <hwy/foreach_target.h>

#include <hwy/highway.h>

#include <algorithm>
#include <cmath>

#include "recon/label_kernel.h"

HWY_BEFORE_NAMESPACE();
namespace elbowroom::recon::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using Floats = hn::CappedTag<float, 8>;
using Ints = hn::Rebind<std::int32_t, Floats>;
using VF = hn::Vec<Floats>;
using VI = hn::Vec<Ints>;

constexpr std::size_t kSide = kBlockPoints;

// As many points as a vector holds.
struct Points {
  VF x;
  VF y;
  VF z;
};

HWY_INLINE VF Set(double number) { return hn::Set(Floats(), static_cast<float>(number)); }

HWY_INLINE Points Times(VF count, const std::array<double, 3>& step) {
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
  Labeller(const LabelRaster& raster, BlockBits* bits, BlockBits* mixed)
      : labels_(reinterpret_cast<const std::int32_t*>(raster.labels.data())),
        origin_x_px_(Set(raster.origin_x_px)),
        origin_y_px_(Set(raster.origin_y_px)),
        cells_per_px_(Set(raster.cells_per_px)),
        width_(Set(raster.width)),
        height_(Set(raster.height)),
        columns_(hn::Set(Ints(), raster.width)),
        bits_(*bits),
        mixed_(*mixed) {}

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
    const Ints n;
    const VF per_z = hn::Div(Set(1.0), points.z), zero = hn::Zero(Floats());
    const VF x = hn::Mul(points.x, per_z), y = hn::Mul(points.y, per_z);
    const VF across = hn::Mul(hn::Sub(x, origin_x_px_), cells_per_px_);
    const VF down = hn::Mul(hn::Sub(y, origin_y_px_), cells_per_px_);
    const auto is_across = hn::And(hn::Ge(across, zero), hn::Lt(across, width_));
    const auto is_down = hn::And(hn::Ge(down, zero), hn::Lt(down, height_));
    const auto is_in_cell = hn::And(is_across, is_down);
    const VI column = hn::ConvertTo(n, hn::IfThenElseZero(is_in_cell, across));
    const VI row = hn::ConvertTo(n, hn::IfThenElseZero(is_in_cell, down));
    return hn::GatherOffset(n, labels_, hn::Add(hn::Mul(row, columns_), column));
  }

  const std::int32_t* const labels_;
  const VF origin_x_px_, origin_y_px_, cells_per_px_, width_, height_;
  const VI columns_;
  BlockBits& bits_;
  BlockBits& mixed_;
  unsigned object_ = 0, unsure_ = 0;
  std::size_t asked_ = 0;
};

// y and z of the far face's points, in the order of their bits.
struct FarPoints {
  alignas(32) std::array<float, 8 * BlockBits::kFarGroups> y{}, z{};
};
constexpr FarPoints MakeFarPoints() {
  FarPoints points;
  for (std::size_t i = 0; i < points.y.size(); ++i) {
    points.y[i] = static_cast<float>(i % kSide);
    points.z[i] = static_cast<float>(i / kSide);
  }
  return points;
}
constexpr FarPoints kFarPoints = MakeFarPoints();

// `block`: its steps, from its own corner.
std::size_t Label(const GridView& block, const LabelRaster& raster, BlockBits* bits, BlockBits* mixed) {
  const Floats f;
  const std::size_t at_once = hn::Lanes(f);
  Labeller labeller(raster, bits, mixed);
  for (std::size_t group = 0; group < BlockBits::kRows; ++group) {
    if (!labeller.Begin(group)) continue;
    const std::array<double, 3> layer =
        Along(block.origin, static_cast<double>(group / kSide), block.steps[2]);
    const Points row = Spread(Along(layer, static_cast<double>(group % kSide), block.steps[1]));
    for (std::size_t i = 0; i < 8; i += at_once)
      labeller.Ask(i, Sum(row, Times(hn::Iota(f, static_cast<float>(i)), block.steps[0])));
    labeller.Finish(group);
  }
  // The far face.
  const Points far = Spread(Along(block.origin, kBlockCells, block.steps[0]));
  for (std::size_t group = BlockBits::kRows; group < BlockBits::kGroups; ++group) {
    if (!labeller.Begin(group)) continue;
    for (std::size_t i = 0; i < 8; i += at_once) {
      const std::size_t point = 8 * (group - BlockBits::kRows) + i;
      const VF y = hn::Load(f, &kFarPoints.y[point]), z = hn::Load(f, &kFarPoints.z[point]);
      labeller.Ask(i, Sum(far, Sum(Times(y, block.steps[1]), Times(z, block.steps[2]))));
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

namespace {

// Whether the kernel's float32 puts all points of a block in front of the camera, each less than kTouchCells
// from where it is. A coordinate is rounded to 2^-24 of itself some six times on the way: its terms, their
// sums; so is what the division leaves, and the place among the cells.
bool FloatsWillDo(const GridView& block, const LabelRaster& raster) {
  constexpr double kRounding = 8.0 / (1 << 24);
  std::array<double, 3> most{}, error{};  // of a coordinate's terms together
  double least_z = block.origin[2];
  for (std::size_t k = 0; k < 3; ++k) {
    most[k] = std::abs(block.origin[k]);
    for (const std::array<double, 3>& step : block.steps) most[k] += kBlockCells * std::abs(step[k]);
    error[k] = kRounding * most[k];
  }
  for (const std::array<double, 3>& step : block.steps) least_z += kBlockCells * std::min(step[2], 0.0);
  least_z -= error[2];
  if (!(least_z > 0.0)) return false;
  // Positions farther out than twice the cells don't come near them by an error that passes below.
  const double reach_px = std::max({std::abs(raster.origin_x_px), std::abs(raster.origin_y_px),
                                    std::abs(raster.origin_x_px + raster.width * raster.cell_px),
                                    std::abs(raster.origin_y_px + raster.height * raster.cell_px)});
  const double error_px =
      (std::max(error[0], error[1]) + 2.0 * reach_px * error[2]) / least_z + kRounding * reach_px;
  return error_px * raster.cells_per_px < LabelRaster::kTouchCells;
}

}  // namespace

std::size_t LabelByCells(const GridView& grid, const GridPoint& corner, const LabelRaster& raster,
                         BlockBits* bits, BlockBits* mixed) {
  GridView block = grid;
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t axis = 0; axis < 3; ++axis)
      block.origin[k] += corner[static_cast<Eigen::Index>(axis)] * grid.steps[axis][k];
  if (FloatsWillDo(block, raster)) return HWY_DYNAMIC_DISPATCH(Label)(block, raster, bits, mixed);
  *mixed = *bits;
  return BlockBits::kGroups - static_cast<std::size_t>(std::ranges::count(bits->groups, 0));
}

}  // namespace elbowroom::recon
#endif
