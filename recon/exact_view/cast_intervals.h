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

// An edge's place along the rays of an angle whose direction is (x, y): order(x, y) = x * dx + y * dy. Each
// ray meets its edges in ascending order.
struct EdgeOrder {
  double dx = 0.0;
  double dy = 0.0;
};

// The orders between which rays of an interval can be in the object, for directions (x, y) with |x| + |y| =
// 1. Empty if first > last.
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

// The bin of an angle; the nearest one for an angle that the view doesn't have.
[[nodiscard]] std::uint32_t BinOf(const CastPencil& pencil, double angle);

// The first and the last interval that rays of these bins can be in.
[[nodiscard]] std::pair<std::size_t, std::size_t> IntervalsOf(const CastPencil& pencil,
                                                              std::uint32_t first_bin,
                                                              std::uint32_t last_bin);

}  // namespace elbowroom::recon
