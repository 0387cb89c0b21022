// Compiled once for each kind of processor; see Highway's foreach_target.h.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "recon/hull_mesh/label_kernel.cc"
#include <hwy/foreach_target.h>

#include <hwy/highway.h>

#include <algorithm>
#include <cmath>

#include "recon/hull_mesh/label_kernel.h"

HWY_BEFORE_NAMESPACE();
namespace elbowroom::recon::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using Floats = hn::CappedTag<float, 8>;
using Ints = hn::Rebind<std::int32_t, Floats>;
using Unsigned = hn::RebindToUnsigned<Ints>;
using VF = hn::Vec<Floats>;
using VI = hn::Vec<Ints>;

constexpr std::size_t kSide = kBlockPoints;

// As many points as a vector holds. x and y are positions among the cells times z, so that one division by z
// gives the cell.
struct Points {
  VF x;
  VF y;
  VF z;
};

HWY_INLINE VF Set(double number) { return hn::Set(Floats(), static_cast<float>(number)); }

HWY_INLINE Points Times(VF count, const Points& step) {
  return {hn::Mul(count, step.x), hn::Mul(count, step.y), hn::Mul(count, step.z)};
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

class Cells {
 public:
  explicit Cells(const ContourCellsView& cells)
      : labels_(reinterpret_cast<const std::int32_t*>(cells.labels.data())),
        origin_x_(Set(cells.origin_x_px * cells.cells_per_px)),
        origin_y_(Set(cells.origin_y_px * cells.cells_per_px)),
        width_(hn::Set(Ints(), cells.width)),
        height_(hn::Set(Ints(), cells.height)) {}

  [[nodiscard]] HWY_INLINE VI LabelsOf(const Points& points) const {
    const VF per_z = hn::Div(Set(1.0), points.z);
    const VI column = CellOf(hn::Sub(hn::Mul(points.x, per_z), origin_x_));
    const VI row = CellOf(hn::Sub(hn::Mul(points.y, per_z), origin_y_));
    const VI index = hn::Add(hn::Mul(row, width_), column);
    // One comparison for 0 <= number < end: read as unsigned, negative numbers are the largest of all.
    const auto is_below = [](VI number, VI end) HWY_ATTR {
      return hn::Lt(hn::BitCast(Unsigned(), number), hn::BitCast(Unsigned(), end));
    };
    const auto is_in_cell = hn::And(is_below(column, width_), is_below(row, height_));
    return hn::GatherOffset(Ints(), labels_, hn::IfThenElseZero(hn::RebindMask(Ints(), is_in_cell), index));
  }

 private:
  // Floor without a conversion: beside 2^23 a float32 has no bits for fractions, so adding 2^23 rounds to a
  // whole number and leaves it in the last bits. Half is taken away first, which makes rounding to the
  // nearest a floor; on the border between two cells it may be either cell, and kTouchCells allows for that.
  // A number that isn't from 0 to 2^23 gives one that is negative or at least 2^23: in no cell.
  static HWY_INLINE VI CellOf(VF number) {
    constexpr double kLastBitIsOne = 1 << 23;
    const VF beside = hn::Add(hn::Sub(number, Set(0.5)), Set(kLastBitIsOne));
    return hn::Sub(hn::BitCast(Ints(), beside), hn::BitCast(Ints(), Set(kLastBitIsOne)));
  }
  const std::int32_t* const labels_;
  const VF origin_x_, origin_y_;
  const VI width_, height_;
};

class Labeller {
 public:
  Labeller(const ContourCellsView& cells, BlockBits* bits, BlockBits* mixed)
      : cells_(cells), bits_(*bits), mixed_(*mixed) {}

  // Labels a group of eight points; points_from(i) are those from point i on. A group without a bit is
  // skipped: an earlier camera has excluded all of it. Bits of mixed cells stay set, and another pass decides
  // them.
  template <typename PointsFrom>
  HWY_INLINE void Ask(std::size_t group, const PointsFrom& points_from) {
    const unsigned bits = bits_.groups[group];
    unsigned object = 0, unsure = 0;
    if (bits != 0) {
      for (std::size_t i = 0; i < 8; i += hn::Lanes(Floats())) {
        const VI label = cells_.LabelsOf(points_from(i));
        object |= BitsOf(label, ContourCellsView::kObject) << i;
        unsure |= BitsOf(label, ContourCellsView::kMixed) << i;
      }
      ++asked_;
    }
    mixed_.groups[group] = static_cast<std::uint8_t>(bits & unsure);
    bits_.groups[group] = static_cast<std::uint8_t>(bits & (object | unsure));
  }
  [[nodiscard]] std::size_t asked() const { return asked_; }

 private:
  const Cells cells_;
  BlockBits& bits_;
  BlockBits& mixed_;
  std::size_t asked_ = 0;
};

// y and z of the points of the far face (x = kBlockCells), in the order of their bits.
struct FarPoints {
  alignas(32) std::array<float, 8 * BlockBits::kFarGroups> y{}, z{};
};
constexpr FarPoints MakeFarPoints() {
  FarPoints points;
  for (std::size_t i = 0; i < points.y.size(); ++i) {
    const std::size_t y = i % kSide, z = i / kSide;
    points.y[i] = static_cast<float>(y);
    points.z[i] = static_cast<float>(z);
  }
  return points;
}
constexpr FarPoints kFarPoints = MakeFarPoints();

// `block`: the grid from the block's own corner, x and y in cells times z. A point's place is linear in its
// three numbers, so rows and layers are reached by adding steps: in double precision from row to row, in
// float32 within a row only.
std::size_t Label(const GridView& block, const ContourCellsView& cells, BlockBits* bits, BlockBits* mixed) {
  const Floats f;
  const GridView view = block;  // a copy, so that the bytes written can't be part of it
  Labeller labeller(cells, bits, mixed);
  const Points step_x = Spread(view.steps[0]);
  const Points near = Times(hn::Iota(f, 0.0F), step_x);
  std::array<double, 3> layer = view.origin;
  for (std::size_t group = 0; group < BlockBits::kRows;) {
    std::array<double, 3> row = layer;
    for (const std::size_t end = group + kSide; group < end; ++group) {
      const Points begin = Sum(near, Spread(row));
      labeller.Ask(group, [&](std::size_t i) HWY_ATTR {
        return i == 0 ? begin : Sum(begin, Times(Set(static_cast<double>(i)), step_x));
      });
      row = Along(row, 1.0, view.steps[1]);
    }
    layer = Along(layer, 1.0, view.steps[2]);
  }
  // The far face.
  const Points far = Spread(Along(view.origin, kBlockCells, view.steps[0]));
  const Points step_y = Spread(view.steps[1]), step_z = Spread(view.steps[2]);
  for (std::size_t group = BlockBits::kRows; group < BlockBits::kGroups; ++group) {
    labeller.Ask(group, [&](std::size_t i) HWY_ATTR {
      const std::size_t point = 8 * (group - BlockBits::kRows) + i;
      const VF y = hn::Load(f, &kFarPoints.y[point]), z = hn::Load(f, &kFarPoints.z[point]);
      return Sum(far, Sum(Times(y, step_y), Times(z, step_z)));
    });
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

// Whether the kernel's float32 is good enough for a block: all of its points come out in front of the camera,
// and each less than kTouchCells from where it is. Six roundings to 2^-24 lie on a coordinate's way (its
// terms and their sums), then those of the division and of the place among the cells; eight are allowed for.
bool FloatsWillDo(const GridView& block, const ContourCellsView& cells) {
  constexpr double kRounding = 8.0 / (1 << 24);
  std::array<double, 3> error{};  // of a coordinate's terms together
  double least_z = block.origin[2];
  for (std::size_t k = 0; k < 3; ++k) {
    double most = std::abs(block.origin[k]);
    for (const std::array<double, 3>& step : block.steps) most += kBlockCells * std::abs(step[k]);
    error[k] = kRounding * most;
  }
  for (const std::array<double, 3>& step : block.steps) least_z += kBlockCells * std::min(step[2], 0.0);
  least_z -= error[2];
  if (!(least_z > 0.0)) return false;
  // A position farther out than twice `reach` isn't moved into the cells by an error that passes below.
  const double left = cells.origin_x_px * cells.cells_per_px, top = cells.origin_y_px * cells.cells_per_px;
  const double reach =
      std::max({std::abs(left), std::abs(top), std::abs(left + cells.width), std::abs(top + cells.height)});
  const double error_cells =
      (std::max(error[0], error[1]) + 2.0 * reach * error[2]) / least_z + kRounding * reach;
  return error_cells < ContourCellsView::kTouchCells;
}

}  // namespace

std::size_t LabelByCells(const GridView& grid, const GridPoint& corner, const ContourCellsView& cells,
                         BlockBits* bits, BlockBits* mixed) {
  GridView block;
  for (std::size_t k = 0; k < 3; ++k) {
    const double scale = k < 2 ? cells.cells_per_px : 1.0;
    block.origin[k] = scale * grid.origin[k];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      block.steps[axis][k] = scale * grid.steps[axis][k];
      block.origin[k] += corner[static_cast<Eigen::Index>(axis)] * block.steps[axis][k];
    }
  }
  if (FloatsWillDo(block, cells)) return HWY_DYNAMIC_DISPATCH(Label)(block, cells, bits, mixed);
  *mixed = *bits;
  return BlockBits::kGroups - static_cast<std::size_t>(std::ranges::count(bits->groups, 0));
}

}  // namespace elbowroom::recon
#endif
