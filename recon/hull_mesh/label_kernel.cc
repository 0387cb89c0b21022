// Compiled once for each kind of processor; see Highway's foreach_target.h.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "recon/hull_mesh/label_kernel.cc"
#include <hwy/foreach_target.h>

#include <hwy/highway.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

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

HWY_INLINE unsigned BitsOf(hn::Mask<Ints> mask) {
  std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(Ints(), mask, bytes);
  return bytes[0];
}
HWY_INLINE unsigned BitsOf(VI label, std::int32_t bit) {
  return BitsOf(hn::TestBit(label, hn::Set(Ints(), bit)));
}

class Cells {
 public:
  explicit Cells(const ContourCellsView& cells)
      : labels_(reinterpret_cast<const std::int32_t*>(cells.labels.data())),
        clear_squares_(reinterpret_cast<const std::int32_t*>(cells.clear_squares.data())),
        half_before_x_(Set(cells.origin_x_px * cells.cells_per_px + 0.5)),
        half_before_y_(Set(cells.origin_y_px * cells.cells_per_px + 0.5)),
        width_(hn::Set(Ints(), cells.width)),
        height_(hn::Set(Ints(), cells.height)),
        last_column_(Set(cells.width - 1)),
        last_row_(Set(cells.height - 1)) {}

  [[nodiscard]] HWY_INLINE VI LabelsOf(const Points& points) const {
    const VF per_z = hn::Div(Set(1.0), points.z);
    const VI column = CellOf(hn::Sub(hn::Mul(points.x, per_z), half_before_x_));
    const VI row = CellOf(hn::Sub(hn::Mul(points.y, per_z), half_before_y_));
    // One comparison for 0 <= number < end: read as unsigned, negative numbers are the largest of all.
    const auto is_below = [](VI number, VI end) HWY_ATTR {
      return hn::Lt(hn::BitCast(Unsigned(), number), hn::BitCast(Unsigned(), end));
    };
    const auto is_in_cell = hn::And(is_below(column, width_), is_below(row, height_));
    const VI index = hn::IfThenElseZero(hn::RebindMask(Ints(), is_in_cell), Index(column, row));
    return hn::GatherOffset(Ints(), labels_, index);
  }

  struct Clear {
    VI squares;  // ContourCellsView::clear_squares
    VI labels;
  };
  // Of the cells that are nearest to the points.
  [[nodiscard]] HWY_INLINE Clear ClearAround(const Points& points) const {
    const VF per_z = hn::Div(Set(1.0), points.z);
    const auto nearest = [](VF number, VF last)
                             HWY_ATTR { return CellOf(hn::Min(hn::Max(number, hn::Zero(Floats())), last)); };
    const VI column = nearest(hn::Sub(hn::Mul(points.x, per_z), half_before_x_), last_column_);
    const VI row = nearest(hn::Sub(hn::Mul(points.y, per_z), half_before_y_), last_row_);
    const VI index = Index(column, row);
    return {hn::And(hn::GatherOffset(Ints(), clear_squares_, index), hn::Set(Ints(), 0xFF)),
            hn::GatherOffset(Ints(), labels_, index)};
  }

 private:
  // Floor of `number` + 1/2 without a conversion: beside 2^23 a float32 has no bits for fractions, so adding
  // 2^23 rounds to the nearest whole number and leaves it in the last bits. On the border between two cells
  // it may be either cell, and kTouchCells allows for that. A number that isn't from 0 to 2^23 gives one that
  // is negative or at least 2^23: in no cell.
  static HWY_INLINE VI CellOf(VF number) {
    constexpr double kLastBitIsOne = 1 << 23;
    const VF beside = hn::Add(number, Set(kLastBitIsOne));
    return hn::Sub(hn::BitCast(Ints(), beside), hn::BitCast(Ints(), Set(kLastBitIsOne)));
  }
  [[nodiscard]] HWY_INLINE VI Index(VI column, VI row) const { return hn::Add(hn::Mul(row, width_), column); }

  const std::int32_t* const labels_;
  const std::int32_t* const clear_squares_;
  const VF half_before_x_, half_before_y_;  // half a cell before the first cell
  const VI width_, height_;
  const VF last_column_, last_row_;
};

// y and z of the rows, in the order of their groups; also of the points of the far face, in that of their
// bits.
struct RowPlaces {
  alignas(32) std::array<float, 8 * BlockBits::kFarGroups> y{}, z{};
};
constexpr RowPlaces kRowPlaces = [] {
  RowPlaces places;
  for (std::size_t i = 0; i < places.y.size(); ++i) {
    const std::size_t y = i % kSide, z = i / kSide;
    places.y[i] = static_cast<float>(y);
    places.z[i] = static_cast<float>(z);
  }
  return places;
}();

// y and z of the bars' middles.
struct BarPlaces {
  alignas(32) std::array<float, kBars> y{}, z{};
};
constexpr BarPlaces kBarPlaces = [] {
  BarPlaces places;
  for (std::size_t i = 0; i < kBars; ++i) {
    const std::size_t y = 2 * (i % kBarsOfSide) + 1, z = 2 * (i / kBarsOfSide) + 1;
    places.y[i] = static_cast<float>(y);
    places.z[i] = static_cast<float>(z);
  }
  return places;
}();

// Where the rows begin.
struct RowBegins {
  alignas(32) std::array<float, 8 * BlockBits::kFarGroups> x, y, z;

  explicit RowBegins(const GridView& view) {
    const Floats f;
    const Points origin = Spread(view.origin), step_y = Spread(view.steps[1]), step_z = Spread(view.steps[2]);
    for (std::size_t i = 0; i < x.size(); i += hn::Lanes(f)) {
      const Points in_face =
          Sum(Times(hn::Load(f, &kRowPlaces.y[i]), step_y), Times(hn::Load(f, &kRowPlaces.z[i]), step_z));
      const Points begin = Sum(origin, in_face);
      hn::Store(begin.x, f, &x[i]), hn::Store(begin.y, f, &y[i]), hn::Store(begin.z, f, &z[i]);
    }
  }
  [[nodiscard]] HWY_INLINE Points Row(std::size_t i) const {
    const Floats f;
    return {hn::Set(f, x[i]), hn::Set(f, y[i]), hn::Set(f, z[i])};
  }
  [[nodiscard]] HWY_INLINE Points Rows(std::size_t i) const {
    const Floats f;
    return {hn::Load(f, &x[i]), hn::Load(f, &y[i]), hn::Load(f, &z[i])};
  }
};

// `view`: the grid from the block's own corner, x and y in cells times z.
BarLabels LabelBars(const GridView& view, const ContourCellsView& all_cells, std::int32_t least_square) {
  const Floats f;
  const Cells cells(all_cells);
  const Points middle = Sum(Spread(view.origin), Times(Set(0.5 * kBlockCells), Spread(view.steps[0])));
  const Points step_y = Spread(view.steps[1]), step_z = Spread(view.steps[2]);
  unsigned clear = 0, object = 0;
  for (std::size_t i = 0; i < kBars; i += hn::Lanes(f)) {
    const Points in_face =
        Sum(Times(hn::Load(f, &kBarPlaces.y[i]), step_y), Times(hn::Load(f, &kBarPlaces.z[i]), step_z));
    const Cells::Clear around = cells.ClearAround(Sum(middle, in_face));
    clear |= BitsOf(hn::Gt(around.squares, hn::Set(Ints(), least_square - 1))) << i;
    object |= BitsOf(around.labels, ContourCellsView::kObject) << i;
  }
  return {clear & object, clear & ~object};
}

class Labeller {
 public:
  Labeller(const ContourCellsView& cells, BlockBits* bits, BlockBits* mixed)
      : cells_(cells), bits_(*bits), mixed_(*mixed) {}

  // Labels a group of eight points; points_from(i) are those from point i on. Bits of mixed cells stay set,
  // and another pass decides them.
  template <typename PointsFrom>
  HWY_INLINE void Ask(std::size_t group, const PointsFrom& points_from) {
    unsigned object = 0, unsure = 0;
    for (std::size_t i = 0; i < 8; i += hn::Lanes(Floats())) {
      const VI label = cells_.LabelsOf(points_from(i));
      object |= BitsOf(label, ContourCellsView::kObject) << i;
      unsure |= BitsOf(label, ContourCellsView::kMixed) << i;
    }
    ++asked_;
    const unsigned bits = bits_.groups[group];
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

// `view` as above. A point's place is linear in its three numbers, so rows are reached by adding steps.
std::size_t LabelRows(const GridView& view, const ContourCellsView& cells, const RowBits& rows,
                      BlockBits* bits, BlockBits* mixed) {
  const Floats f;
  const RowBegins begins(view);
  Labeller labeller(cells, bits, mixed);
  const Points step_x = Spread(view.steps[0]);
  const Points near = Times(hn::Iota(f, 0.0F), step_x);
  for (std::size_t word = 0; word < rows.words.size(); ++word) {
    for (std::uint64_t left = rows.words[word]; left != 0; left &= left - 1) {
      const std::size_t row = 64 * word + static_cast<std::size_t>(std::countr_zero(left));
      if (bits->groups[row] == 0) continue;  // an earlier camera has excluded all of it
      const Points begin = Sum(near, begins.Row(row));
      labeller.Ask(row, [&](std::size_t i) HWY_ATTR {
        return i == 0 ? begin : Sum(begin, Times(Set(static_cast<double>(i)), step_x));
      });
    }
  }
  // The far face.
  const Points across = Times(Set(kBlockCells), step_x);
  for (std::size_t i = 0; i < BlockBits::kFarGroups; ++i) {
    const std::size_t group = BlockBits::kRows + i;
    if ((bits->groups[group] & (rows.words[i / 8] >> (8 * (i % 8)) & 0xFFU)) == 0) continue;
    labeller.Ask(group, [&](std::size_t point) HWY_ATTR { return Sum(across, begins.Rows(8 * i + point)); });
  }
  return labeller.asked();
}

}  // namespace
}  // namespace elbowroom::recon::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace elbowroom::recon {

HWY_EXPORT(LabelBars);
HWY_EXPORT(LabelRows);

namespace {

constexpr std::size_t kRows = BlockBits::kRows;

// Rows of each bar: those on the face between two bars are in both.
constexpr std::array<RowBits, kBars> kRowsOfBars = [] {
  std::array<RowBits, kBars> rows{};
  for (std::size_t bar = 0; bar < kBars; ++bar) {
    for (std::size_t z = 0; z <= 2; ++z) {
      for (std::size_t y = 0; y <= 2; ++y) {
        const std::size_t row = 2 * (bar % kBarsOfSide) + y + kBlockPoints * (2 * (bar / kBarsOfSide) + z);
        rows[bar].words[row / 64] |= std::uint64_t{1} << (row % 64);
      }
    }
  }
  return rows;
}();
constexpr RowBits kAllRows = [] {
  RowBits all;
  for (const RowBits& rows : kRowsOfBars)
    for (std::size_t i = 0; i < all.words.size(); ++i) all.words[i] |= rows.words[i];
  return all;
}();

RowBits RowsOf(unsigned bars) {
  RowBits rows;
  for (; bars != 0; bars &= bars - 1) {
    const RowBits& more = kRowsOfBars[static_cast<std::size_t>(std::countr_zero(bars))];
    rows.words[0] |= more.words[0], rows.words[1] |= more.words[1];
  }
  return rows;
}

void ClearRows(const RowBits& rows, BlockBits* bits) {
  for (std::size_t word = 0; word < rows.words.size(); ++word)
    for (std::uint64_t left = rows.words[word]; left != 0; left &= left - 1)
      bits->groups[64 * word + static_cast<std::size_t>(std::countr_zero(left))] = 0;
  for (std::size_t i = 0; i < BlockBits::kFarGroups; ++i) {
    std::uint8_t& far = bits->groups[kRows + i];
    far = static_cast<std::uint8_t>(far & ~(rows.words[i / 8] >> (8 * (i % 8))));
  }
}

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

// The least clear square at which no edge reaches a bar whose middle is in the cell. From the middle p, with
// u = p / p_z, to the bar's corner p + s the picture moves by (s - u s_z) / (p_z + s_z). This is linear in u
// but for the depth, and u of the middles is among those of the block's corners.
std::int32_t LeastClearSquare(const GridView& block) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  double least_z = kInfinity, low[2] = {kInfinity, kInfinity}, high[2] = {-kInfinity, -kInfinity};
  for (unsigned corner = 0; corner < 8; ++corner) {
    std::array<double, 3> at = block.origin;
    for (std::size_t axis = 0; axis < 3; ++axis)
      if ((corner >> axis & 1U) != 0)
        for (std::size_t k = 0; k < 3; ++k) at[k] += kBlockCells * block.steps[axis][k];
    least_z = std::min(least_z, at[2]);
    const double per_z = 1.0 / at[2];
    for (std::size_t k = 0; k < 2; ++k) {
      const double u = at[k] * per_z;
      low[k] = std::min(low[k], u), high[k] = std::max(high[k], u);
    }
  }
  double reach2 = 0.0;
  for (const double y : {-1.0, 1.0}) {
    for (const double z : {-1.0, 1.0}) {
      const auto way = [&](std::size_t k) {
        return 0.5 * kBlockCells * block.steps[0][k] + y * block.steps[1][k] + z * block.steps[2][k];
      };
      double way2 = 0.0;
      for (std::size_t k = 0; k < 2; ++k) {
        const double most = std::max(std::abs(way(k) - way(2) * low[k]), std::abs(way(k) - way(2) * high[k]));
        way2 += most * most;
      }
      reach2 = std::max(reach2, way2);
    }
  }
  // From the middle to its cell's centre and from an edge to its own, half a diagonal each. The middle and
  // the edge may both be kTouchCells beside their cells; twice that leaves room for the rounding here.
  constexpr double kDiagonal = 1.4142135623730951;
  const double least = std::sqrt(reach2) / least_z + kDiagonal + 4.0 * ContourCellsView::kTouchCells;
  constexpr double kNoByte = 256.0;
  return static_cast<std::int32_t>(std::min(least * least, kNoByte - 1.0)) + 1;
}

}  // namespace

BlockInCells::BlockInCells(const GridView& grid, const GridPoint& corner, const ContourCellsView& cells)
    : cells_(cells), rows_(kAllRows) {
  for (std::size_t k = 0; k < 3; ++k) {
    const double scale = k < 2 ? cells.cells_per_px : 1.0;
    view_.origin[k] = scale * grid.origin[k];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      view_.steps[axis][k] = scale * grid.steps[axis][k];
      view_.origin[k] += corner[static_cast<Eigen::Index>(axis)] * view_.steps[axis][k];
    }
  }
  floats_will_do_ = FloatsWillDo(view_, cells);
}

std::size_t BlockInCells::LabelBars(BlockBits* bits) {
  if (!floats_will_do_ || cells_.width == 0) return 0;
  const BarLabels labels = HWY_DYNAMIC_DISPATCH(LabelBars)(view_, cells_, LeastClearSquare(view_));
  const RowBits background = RowsOf(labels.background), object = RowsOf(labels.object);
  ClearRows(background, bits);
  for (std::size_t i = 0; i < rows_.words.size(); ++i)
    rows_.words[i] &= ~(background.words[i] | object.words[i]);
  return kBars;
}

std::size_t BlockInCells::LabelRows(BlockBits* bits, BlockBits* mixed) const {
  if (floats_will_do_) {
    if ((rows_.words[0] | rows_.words[1]) == 0) return 0;
    return 8 * HWY_DYNAMIC_DISPATCH(LabelRows)(view_, cells_, rows_, bits, mixed);
  }
  *mixed = *bits;
  return 8 * (BlockBits::kGroups - static_cast<std::size_t>(std::ranges::count(bits->groups, 0)));
}

}  // namespace elbowroom::recon
#endif
