// A pencil's edges in the order in which rays meet them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "recon/exact_view/tile_cast.h"

namespace elbowroom::recon {

// Where on the way along the rays at angle of direction (x, y) an edge is: order(x, y) = x * dx + y * dy.
struct EdgeOrder {
  double dx = 0.0;
  double dy = 0.0;
};

// Between which orders rays of an interval can be in the object, their directions (x, y) of |x| + |y| = 1.
// Nowhere: first > last.
struct OrderRange {
  double first = -std::numeric_limits<double>::infinity();
  double last = std::numeric_limits<double>::infinity();
};

// Fills the pencil's intervals and bins from its edges (from < to) and the order of each. Returns one range
// an interval. Contours don't cross themselves, so the order changes only where edges begin or end.
// Derivation: docs/exact_view.md.
[[nodiscard]] std::vector<OrderRange> FillIntervals(std::span<const EdgeOrder> orders, CastPencil* pencil);

// Room for the rounding of rays' angles to float32.
inline constexpr double kAngleSlack = 1e-6;

// The nearest bin for angles that the view doesn't have.
[[nodiscard]] std::uint32_t BinOf(const CastPencil& pencil, double angle);

// The first and the last interval that rays of these bins can be in.
[[nodiscard]] std::pair<std::size_t, std::size_t> IntervalsOf(const CastPencil& pencil,
                                                              std::uint32_t first_bin,
                                                              std::uint32_t last_bin);

}  // namespace elbowroom::recon
