// Compiled once for each kind of processor; see Highway's foreach_target.h.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "recon/contours/contour_kernel.cc"
#include <hwy/foreach_target.h>

#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include "recon/contours/contour_kernel.h"

HWY_BEFORE_NAMESPACE();
namespace elbowroom::recon::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

// Points side by side; no fused operation anywhere: it would round differently on processors without one.
using Doubles = hn::CappedTag<double, 8>;
using Ints = hn::Rebind<std::int32_t, Doubles>;
using Indices = hn::Rebind<std::int64_t, Doubles>;
using DoubleVec = hn::Vec<Doubles>;
using IntVec = hn::Vec<Ints>;
// Edges side by side: a cell has two or three.
using Edges = hn::CappedTag<double, ContourCellsView::kEdgesBehind>;
using EdgeVec = hn::Vec<Edges>;
using EdgeMask = hn::Mask<Edges>;

constexpr std::size_t kMost = GridPoints::kMost;
constexpr double kCellDiagonal = 1.4142135623730951;
// For each clear square: how far positions in its cell are from all edges at least, in cells. Reading this is
// several times as fast as a root.
const std::array<double, 256> kClearCells = []() noexcept {
  std::array<double, 256> cells{};
  for (std::size_t i = 0; i < cells.size(); ++i) cells[i] = std::sqrt(static_cast<double>(i)) - kCellDiagonal;
  return cells;
}();
// Rounding of a position and of a distance.
constexpr double kRoundingPx = 1e-7;

HWY_INLINE DoubleVec Set(double number) { return hn::Set(Doubles(), number); }
HWY_INLINE EdgeVec SetE(double number) { return hn::Set(Edges(), number); }

struct EdgeLanes {
  EdgeVec ax, ay, bx, by;
};
HWY_INLINE EdgeLanes Load(const ContourCellsView::Edge* edges) {
  EdgeLanes lanes;
  hn::LoadInterleaved4(Edges(), &edges->from_x, lanes.ax, lanes.ay, lanes.bx, lanes.by);
  return lanes;
}

// From the centre c along the row to the position's x, then along the column to the position p: both legs
// stay in the cell, so its edges are all that matter. Each edge decides once on which side of it the legs
// meet, or an edge through that very corner would count for one leg and not for the other.
HWY_INLINE EdgeMask ParityFlips(const EdgeLanes& e, EdgeVec cx, EdgeVec cy, EdgeVec px, EdgeVec py) {
  const EdgeVec zero = hn::Zero(Edges());
  const EdgeVec along_x = hn::Sub(e.bx, e.ax), along_y = hn::Sub(e.by, e.ay);
  const EdgeMask rises = hn::Gt(hn::Mul(along_x, along_y), zero);
  const EdgeMask in_row = hn::Xor(hn::Gt(e.ay, cy), hn::Gt(e.by, cy));
  const EdgeVec x = hn::Add(e.ax, hn::Mul(hn::Div(hn::Sub(cy, e.ay), along_y), along_x));
  const EdgeMask corner_is_right = hn::Le(x, px);
  const EdgeMask changes = hn::And(in_row, hn::Xor(corner_is_right, hn::Le(x, cx)));
  const EdgeMask corner_is_below =
      hn::Or(hn::And(in_row, hn::Xor(corner_is_right, rises)), hn::AndNot(in_row, hn::Le(e.ay, cy)));
  const EdgeMask in_column = hn::Xor(hn::Gt(e.ax, px), hn::Gt(e.bx, px));
  const EdgeVec y = hn::Add(e.ay, hn::Mul(hn::Div(hn::Sub(px, e.ax), along_x), along_y));
  const EdgeMask p_is_below = hn::Or(hn::Lt(y, py), hn::AndNot(rises, hn::Eq(y, py)));
  return hn::Xor(changes, hn::And(in_column, hn::Xor(corner_is_below, p_is_below)));
}

bool LabelDiffers(const ContourCellsView::Edge* edges, std::size_t count, const double* centre,
                  const double* position) {
  const EdgeVec cx = SetE(centre[0]), cy = SetE(centre[1]), px = SetE(position[0]), py = SetE(position[1]);
  const Edges d;
  std::size_t changes = 0;
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
    const EdgeMask is_there = hn::FirstN(d, count - i);
    changes += hn::CountTrue(d, hn::And(is_there, ParityFlips(Load(edges + i), cx, cy, px, py)));
  }
  return changes % 2 != 0;
}

// As many points as a vector holds, in a picture plane.
struct Points {
  DoubleVec x, y, z;
};

HWY_INLINE Points Project(const GridView& grid, const GridPoints& points, std::size_t i) {
  const Doubles d;
  const DoubleVec x = hn::Load(d, &points.at[0][i]), y = hn::Load(d, &points.at[1][i]),
                  z = hn::Load(d, &points.at[2][i]);
  const auto coordinate = [&](std::size_t k) HWY_ATTR {
    const DoubleVec in_layer = hn::Add(hn::Mul(x, Set(grid.steps[0][k])), hn::Mul(y, Set(grid.steps[1][k])));
    return hn::Add(in_layer, hn::Add(Set(grid.origin[k]), hn::Mul(z, Set(grid.steps[2][k]))));
  };
  const DoubleVec z_mm = coordinate(2), per_z = hn::Div(Set(1.0), z_mm);
  return {hn::Mul(coordinate(0), per_z), hn::Mul(coordinate(1), per_z), z_mm};
}

HWY_INLINE DoubleVec InCells(const ContourCellsView& cells, DoubleVec px, double origin_px) {
  return hn::Mul(hn::Sub(px, Set(origin_px)), Set(cells.cells_per_px));
}
HWY_INLINE IntVec Index(const ContourCellsView& cells, IntVec column, IntVec row) {
  return hn::Add(hn::Mul(row, hn::Set(Ints(), cells.width)), column);
}
HWY_INLINE IntVec Bytes(std::span<const std::uint8_t> bytes, IntVec index) {
  const IntVec words = hn::GatherOffset(Ints(), reinterpret_cast<const std::int32_t*>(bytes.data()), index);
  return hn::And(words, hn::Set(Ints(), 0xFF));
}
template <typename D, typename M>
HWY_INLINE std::uint64_t BitsOf(D d, M mask) {
  std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(d, mask, bytes);
  return bytes[0];
}

// Bits of the points that are there.
std::uint64_t PointsInUse(const GridPoints& points) {
  return points.count == 0 ? 0 : ~std::uint64_t{0} >> (kMost - points.count);
}

std::uint64_t LabelSome(const GridView& grid, const ContourCellsView& cells, const GridPoints& points,
                        std::uint64_t wanted) {
  const Doubles d;
  const Ints n;
  const DoubleVec zero = hn::Zero(d);
  std::uint64_t object = 0, mixed = 0;
  alignas(64) double x[kMost], y[kMost];
  alignas(32) std::int32_t columns[kMost], rows[kMost], indices[kMost];
  for (std::size_t begin = 0; begin < points.count; begin += hn::Lanes(d)) {
    const Points p = Project(grid, points, begin);
    const DoubleVec across = InCells(cells, p.x, cells.origin_x_px),
                    down = InCells(cells, p.y, cells.origin_y_px);
    // Written so that a NaN is in no cell.
    const auto is_across = hn::And(hn::Ge(across, zero), hn::Lt(across, Set(cells.width)));
    const auto is_down = hn::And(hn::Ge(down, zero), hn::Lt(down, Set(cells.height)));
    const auto is_in_cell = hn::And(hn::And(is_across, is_down), hn::Gt(p.z, zero));
    const IntVec column = hn::DemoteTo(n, hn::IfThenElseZero(is_in_cell, across));
    const IntVec row = hn::DemoteTo(n, hn::IfThenElseZero(is_in_cell, down));
    const IntVec index = Index(cells, column, row), label = Bytes(cells.labels, index);
    object |= BitsOf(n, hn::TestBit(label, hn::Set(n, ContourCellsView::kObject))) << begin;
    mixed |= BitsOf(n, hn::TestBit(label, hn::Set(n, ContourCellsView::kMixed))) << begin;
    hn::Store(p.x, d, x + begin), hn::Store(p.y, d, y + begin);
    hn::Store(column, n, columns + begin), hn::Store(row, n, rows + begin),
        hn::Store(index, n, indices + begin);
  }
  wanted &= PointsInUse(points);
  for (mixed &= wanted; mixed != 0; mixed &= mixed - 1) {
    const auto i = static_cast<std::size_t>(std::countr_zero(mixed));
    const double centre[2] = {cells.origin_x_px + cells.cell_px * (columns[i] + 0.5),
                              cells.origin_y_px + cells.cell_px * (rows[i] + 0.5)};
    const double position[2] = {x[i], y[i]};
    const std::uint32_t* const first = cells.first.data() + indices[i];
    const bool changes = LabelDiffers(cells.edges.data() + first[0], first[1] - first[0], centre, position);
    object ^= std::uint64_t{changes} << i;
  }
  return object & wanted;
}

// Ways in the picture, and the cells that their boxes reach to.
struct Ways {
  alignas(64) double from_x[kMost], from_y[kMost], from_z[kMost];
  alignas(64) double to_x[kMost], to_y[kMost], to_z[kMost];
  alignas(32) std::int32_t left[kMost], right[kMost], top[kMost], bottom[kMost];
};

class Way {
 public:
  HWY_INLINE Way(const Ways& ways, std::size_t i)
      : from_x_(SetE(ways.from_x[i])),
        from_y_(SetE(ways.from_y[i])),
        way_x_(hn::Sub(SetE(ways.to_x[i]), from_x_)),
        way_y_(hn::Sub(SetE(ways.to_y[i]), from_y_)),
        side_of_way_(Cross(way_x_, way_y_, from_x_, from_y_)) {}

  // For each lane the lesser of `nearest` and the share at which the way meets that lane's edge. Only the
  // first `count` edges are there.
  [[nodiscard]] HWY_INLINE EdgeVec Meet(const ContourCellsView::Edge* edges, std::size_t count,
                                        EdgeVec nearest) const {
    const Edges d;
    const EdgeVec zero = hn::Zero(d);
    const EdgeLanes e = Load(edges);
    // The way meets the edge if the edge's ends are on different sides of the way's line and the share at
    // which that line meets the edge's line is on the way: from 0 to `nearest`.
    const EdgeVec side_a = hn::Sub(Cross(way_x_, way_y_, e.ax, e.ay), side_of_way_);
    const EdgeVec side_b = hn::Sub(Cross(way_x_, way_y_, e.bx, e.by), side_of_way_);
    const EdgeVec apart =
        Cross(hn::Sub(e.ax, from_x_), hn::Sub(e.ay, from_y_), hn::Sub(e.bx, e.ax), hn::Sub(e.by, e.ay));
    const EdgeVec share = hn::Div(apart, hn::Sub(side_b, side_a));
    const EdgeMask is_there = hn::Lt(hn::Iota(d, 0.0), SetE(static_cast<double>(count)));
    const EdgeMask differs = hn::And(is_there, hn::Xor(hn::Gt(side_a, zero), hn::Gt(side_b, zero)));
    const EdgeMask meets = hn::And(hn::And(differs, hn::Ge(share, zero)), hn::Le(share, nearest));
    return hn::IfThenElse(meets, share, nearest);
  }

 private:
  static HWY_INLINE EdgeVec Cross(EdgeVec ax, EdgeVec ay, EdgeVec bx, EdgeVec by) {
    return hn::Sub(hn::Mul(ax, by), hn::Mul(ay, bx));
  }

  const EdgeVec from_x_, from_y_, way_x_, way_y_, side_of_way_;
};

// The least share at which way i meets an edge of the cells in its box; more than 1 if there is none.
HWY_INLINE double FirstCrossing(const ContourCellsView& cells, const Ways& ways, std::size_t i) {
  const Edges d;
  const Way way(ways, i);
  EdgeVec nearest = SetE(kNoCrossing);
  for (std::int32_t row = ways.top[i]; row <= ways.bottom[i]; ++row) {
    const std::uint32_t* const first = cells.first.data() + row * cells.width;
    const std::size_t end = first[ways.right[i] + 1];
    for (std::size_t at = first[ways.left[i]]; at < end; at += hn::Lanes(d))
      nearest = way.Meet(cells.edges.data() + at, end - at, nearest);
  }
  return hn::GetLane(hn::MinOfLanes(d, nearest));
}

// A bit for each way from i on, as many as a vector holds, that may meet an edge. A way can't if half its
// length is less than the clearance around its middle. Where the middle is outside of the cells, the nearest
// cell's clearance serves: from there the edges are no farther. Shares that can't be worked out become
// kUnknownCrossing.
HWY_INLINE std::uint64_t WaysNearEdges(const ContourCellsView& cells, const Points& from, const Points& to,
                                       std::size_t i, Ways* ways, double* shares) {
  const Doubles d;
  const Ints n;
  const DoubleVec zero = hn::Zero(d), largest = Set(std::numeric_limits<double>::max());
  const auto is_finite = [&](DoubleVec a, DoubleVec b) HWY_ATTR {
    return hn::And(hn::Le(hn::Abs(a), largest), hn::Le(hn::Abs(b), largest));
  };
  const auto is_in_front = hn::And(hn::Gt(from.z, zero), hn::Gt(to.z, zero));
  const auto is_known = hn::And(is_in_front, hn::And(is_finite(from.x, from.y), is_finite(to.x, to.y)));
  hn::Store(hn::IfThenElse(is_known, hn::Load(d, shares + i), Set(kUnknownCrossing)), d, shares + i);
  const auto nearest_cell = [&](DoubleVec px, double origin_px, std::int32_t count) HWY_ATTR {
    const DoubleVec at = hn::IfThenElseZero(is_known, InCells(cells, px, origin_px));
    return hn::DemoteTo(n, hn::Min(hn::Max(at, zero), Set(count - 1)));
  };
  const DoubleVec half = Set(0.5);
  const DoubleVec x = hn::Mul(half, hn::Add(from.x, to.x)), y = hn::Mul(half, hn::Add(from.y, to.y));
  const IntVec middle = Index(cells, nearest_cell(x, cells.origin_x_px, cells.width),
                              nearest_cell(y, cells.origin_y_px, cells.height));
  const DoubleVec clear_cells =
      hn::GatherIndex(d, kClearCells.data(), hn::PromoteTo(Indices(), Bytes(cells.clear_squares, middle)));
  const DoubleVec clear_px = hn::Sub(hn::Mul(clear_cells, Set(cells.cell_px)), Set(kRoundingPx));
  const DoubleVec half_x = hn::Sub(to.x, x), half_y = hn::Sub(to.y, y);
  const DoubleVec reach2 = hn::Add(hn::Mul(half_x, half_x), hn::Mul(half_y, half_y));
  const auto is_far = hn::And(hn::Gt(clear_px, zero), hn::Gt(hn::Mul(clear_px, clear_px), reach2));
  const std::uint64_t near = BitsOf(d, hn::AndNot(is_far, is_known));
  if (near == 0) return 0;
  hn::Store(from.x, d, ways->from_x + i), hn::Store(from.y, d, ways->from_y + i);
  hn::Store(to.x, d, ways->to_x + i), hn::Store(to.y, d, ways->to_y + i);
  hn::Store(from.z, d, ways->from_z + i), hn::Store(to.z, d, ways->to_z + i);
  const IntVec x0 = nearest_cell(from.x, cells.origin_x_px, cells.width),
               x1 = nearest_cell(to.x, cells.origin_x_px, cells.width),
               y0 = nearest_cell(from.y, cells.origin_y_px, cells.height),
               y1 = nearest_cell(to.y, cells.origin_y_px, cells.height);
  hn::Store(hn::Min(x0, x1), n, ways->left + i), hn::Store(hn::Max(x0, x1), n, ways->right + i);
  hn::Store(hn::Min(y0, y1), n, ways->top + i), hn::Store(hn::Max(y0, y1), n, ways->bottom + i);
  return near << i;
}

void LowerShares(const GridView& grid, const ContourCellsView& cells, const GridPoints& from,
                 const GridPoints& to, double* shares) {
  const Doubles d;
  Ways ways;
  std::uint64_t near = 0;
  for (std::size_t i = 0; i < from.count; i += hn::Lanes(d))
    near |= WaysNearEdges(cells, Project(grid, from, i), Project(grid, to, i), i, &ways, shares);
  alignas(64) double in_picture[kMost];
  for (std::size_t i = 0; i < from.count; i += hn::Lanes(d)) hn::Store(Set(kNoCrossing), d, in_picture + i);
  near &= PointsInUse(from);
  for (std::uint64_t left = near; left != 0; left &= left - 1) {
    const auto i = static_cast<std::size_t>(std::countr_zero(left));
    in_picture[i] = FirstCrossing(cells, ways, i);
  }
  // From a share s of the way in the picture to one in space. In the picture 1 / z is linear, so the share in
  // space is s from_z / (to_z + s (from_z - to_z)).
  for (std::size_t i = 0; i < from.count; i += hn::Lanes(d)) {
    if ((near >> i & ((std::uint64_t{1} << hn::Lanes(d)) - 1)) == 0) continue;  // nothing is met
    const DoubleVec share = hn::Load(d, in_picture + i), so_far = hn::Load(d, shares + i);
    const DoubleVec from_z = hn::Load(d, ways.from_z + i), to_z = hn::Load(d, ways.to_z + i);
    const DoubleVec in_space =
        hn::Div(hn::Mul(share, from_z), hn::Add(to_z, hn::Mul(share, hn::Sub(from_z, to_z))));
    const auto is_nearer = hn::And(hn::Le(share, Set(1.0)), hn::Lt(in_space, so_far));
    hn::Store(hn::IfThenElse(is_nearer, in_space, so_far), d, shares + i);
  }
}

// A strip between two parallel lines that holds something convex: (x, y) . p is from `low` to `high` for all
// of its points p.
struct Slab {
  double x, y, low, high;
};

constexpr std::size_t kCorners = ConvexCorners::kCount;
constexpr std::size_t kSlabs = 5;

struct SeenCorners {
  alignas(64) double x[kCorners], y[kCorners];
  bool are_in_front = false;
};

SeenCorners ProjectCorners(const GridView& grid, const ConvexCorners& corners) {
  const Doubles d;
  SeenCorners seen;
  DoubleVec least_z = Set(std::numeric_limits<double>::max());
  for (std::size_t i = 0; i < kCorners; i += hn::Lanes(d)) {
    const Points p = Project(grid, corners.points, i);
    hn::Store(p.x, d, seen.x + i), hn::Store(p.y, d, seen.y + i);
    least_z = hn::Min(least_z, p.z);
  }
  seen.are_in_front = hn::GetLane(hn::MinOfLanes(d, least_z)) > 0.0;
  return seen;
}

// Between which values of (x, y) . corner all corners are, grown by `slack_px` to both sides: by at least
// that distance, since |x| + |y| is no less than the length of (x, y).
HWY_INLINE Slab SlabAlong(const SeenCorners& corners, double x, double y, double slack_px) {
  const Doubles d;
  DoubleVec low = Set(std::numeric_limits<double>::max()), high = hn::Neg(low);
  for (std::size_t i = 0; i < kCorners; i += hn::Lanes(d)) {
    const DoubleVec at =
        hn::Add(hn::Mul(hn::Load(d, corners.x + i), Set(x)), hn::Mul(hn::Load(d, corners.y + i), Set(y)));
    low = hn::Min(low, at), high = hn::Max(high, at);
  }
  const double slack = slack_px * (std::abs(x) + std::abs(y));
  return {x, y, hn::GetLane(hn::MinOfLanes(d, low)) - slack, hn::GetLane(hn::MaxOfLanes(d, high)) + slack};
}

// Lanes: the contour's edges that a line separates from the body. Two convex things that have a separating
// line don't meet, so `true` is certain; not every separating line is tried, so `false` is not. First the
// slabs: the body is between their two lines, an edge with both ends beyond one of them is clear. Then the
// edge's own line: `side` is twice the area of the triangle of edge and corner, so it has one sign for all
// corners that are on one side of the line, and its size is the corner's distance times the edge's length.
// The length is bounded by |x| + |y|, which only makes the slack larger.
HWY_INLINE EdgeMask AreBeside(const EdgeLanes& e, const Slab* slabs, const SeenCorners& corners,
                              double slack_px) {
  const Edges d;
  EdgeMask beside = hn::FirstN(d, 0);
  for (std::size_t i = 0; i < kSlabs; ++i) {
    const EdgeVec x = SetE(slabs[i].x), y = SetE(slabs[i].y);
    const EdgeVec a = hn::Add(hn::Mul(e.ax, x), hn::Mul(e.ay, y)),
                  b = hn::Add(hn::Mul(e.bx, x), hn::Mul(e.by, y));
    beside = hn::Or(beside, hn::Or(hn::Lt(hn::Max(a, b), SetE(slabs[i].low)),
                                   hn::Gt(hn::Min(a, b), SetE(slabs[i].high))));
  }
  if (hn::AllTrue(d, beside)) return beside;
  const EdgeVec along_x = hn::Sub(e.bx, e.ax), along_y = hn::Sub(e.by, e.ay);
  EdgeVec low = SetE(std::numeric_limits<double>::max()), high = hn::Neg(low);
  for (std::size_t i = 0; i < kCorners; ++i) {
    const EdgeVec side = hn::Sub(hn::Mul(along_x, hn::Sub(SetE(corners.y[i]), e.ay)),
                                 hn::Mul(along_y, hn::Sub(SetE(corners.x[i]), e.ax)));
    low = hn::Min(low, side), high = hn::Max(high, side);
  }
  const EdgeVec slack = hn::Mul(SetE(slack_px), hn::Add(hn::Abs(along_x), hn::Abs(along_y)));
  return hn::Or(beside, hn::Or(hn::Gt(low, slack), hn::Lt(high, hn::Neg(slack))));
}

bool IsClear(const GridView& grid, const ConvexCorners& shape, const ContourCellsView& cells,
             double slack_px) {
  const SeenCorners corners = ProjectCorners(grid, shape);
  if (!corners.are_in_front) return false;
  Slab slabs[kSlabs] = {SlabAlong(corners, 1.0, 0.0, slack_px), SlabAlong(corners, 0.0, 1.0, slack_px)};
  const auto cell = [&](double px, double origin_px, std::int32_t count) {
    return static_cast<std::int32_t>(
        std::clamp(std::floor((px - origin_px) * cells.cells_per_px), -1.0, static_cast<double>(count)));
  };
  const std::int32_t left = cell(slabs[0].low, cells.origin_x_px, cells.width),
                     right = cell(slabs[0].high, cells.origin_x_px, cells.width),
                     top = cell(slabs[1].low, cells.origin_y_px, cells.height),
                     bottom = cell(slabs[1].high, cells.origin_y_px, cells.height);
  // All edges are within the cells.
  if (right < 0 || bottom < 0 || left == cells.width || top == cells.height) return true;
  if (bottom - top >= kMostConvexRows) return false;
  const Edges d;
  bool has_slabs = false;
  // The middle row first: an edge that the body covers is most likely there.
  for (std::int32_t row = std::max(top, 0); row <= std::min(bottom, cells.height - 1); ++row) {
    const std::uint32_t* const first = cells.first.data() + row * cells.width;
    const std::size_t end = first[std::min(right, cells.width - 1) + 1];
    for (std::size_t i = first[std::max(left, 0)]; i < end; i += hn::Lanes(d)) {
      if (!has_slabs) {
        for (std::size_t side = 0; side < shape.sides.size(); ++side) {
          const auto [from, to] = shape.sides[side];
          slabs[2 + side] =
              SlabAlong(corners, corners.y[from] - corners.y[to], corners.x[to] - corners.x[from], slack_px);
        }
        has_slabs = true;
      }
      const EdgeMask is_there = hn::FirstN(d, end - i);
      const EdgeMask beside = AreBeside(Load(cells.edges.data() + i), slabs, corners, slack_px);
      if (!hn::AllFalse(d, hn::AndNot(beside, is_there))) return false;
    }
  }
  return true;
}

}  // namespace
}  // namespace elbowroom::recon::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace elbowroom::recon {

HWY_EXPORT(LabelDiffers);
HWY_EXPORT(LabelSome);
HWY_EXPORT(LowerShares);
HWY_EXPORT(IsClear);

bool LabelDiffersInCell(std::span<const ContourCellsView::Edge> edges, const std::array<double, 2>& centre_px,
                        const std::array<double, 2>& position_px) {
  return HWY_DYNAMIC_DISPATCH(LabelDiffers)(edges.data(), edges.size(), centre_px.data(), position_px.data());
}

std::uint64_t LabelPoints(const GridView& grid, const ContourCellsView& cells, const GridPoints& points,
                          std::uint64_t wanted) {
  return HWY_DYNAMIC_DISPATCH(LabelSome)(grid, cells, points, wanted);
}

void LowerToCrossings(const GridView& grid, const ContourCellsView& cells, const GridPoints& from,
                      const GridPoints& to, WayShares* shares) {
  if (cells.width == 0) return;  // no edges: everywhere the exterior's label
  HWY_DYNAMIC_DISPATCH(LowerShares)(grid, cells, from, to, shares->at.data());
}

const ConvexCorners& ConvexCorners::OfBox() {
  static const ConvexCorners box = [] {
    ConvexCorners made{{}, {{{0, 1}, {0, 2}, {0, 4}}}};
    made.points.count = kCount;
    for (std::size_t i = 0; i < kCount; ++i)
      for (std::size_t axis = 0; axis < 3; ++axis)
        made.points.at[axis][i] = ((i >> axis) & 1U) != 0 ? 1.0 : -1.0;
    return made;
  }();
  return box;
}

const ConvexCorners& ConvexCorners::OfTriangle() {
  static const ConvexCorners triangle = [] {
    ConvexCorners made{{}, {{{0, 1}, {0, 2}, {1, 2}}}};
    made.points.count = kCount;  // the missing corners are the first one again
    made.points.at[0][1] = made.points.at[1][2] = 1.0;
    return made;
  }();
  return triangle;
}

bool IsClearOfEdges(const GridView& grid, const ConvexCorners& corners, const ContourCellsView& cells,
                    double slack_px) {
  return HWY_DYNAMIC_DISPATCH(IsClear)(grid, corners, cells, slack_px);
}

}  // namespace elbowroom::recon
#endif
