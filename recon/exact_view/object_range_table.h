// Where along the rays a camera's object can be, over any range of angles at once.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "recon/exact_view/cast_intervals.h"

namespace elbowroom::recon {

// The union of the ranges of all intervals that angles from one to another touch, for bins of angles: a
// sparse table, two items a question whatever its width. Never less than the union over the angles
// themselves. Immutable.
class ObjectRangeTable {
 public:
  ObjectRangeTable() = default;
  // `begins` as CastIntervals::begins, one range an interval.
  ObjectRangeTable(std::span<const float> begins, std::span<const OrderRange> ranges);

  [[nodiscard]] OrderRange Over(double least_angle, double most_angle) const;

 private:
  [[nodiscard]] std::size_t BinOf(double angle) const;

  double first_angle_ =
      0.0;  // bin 1 begins here: bin 0 takes what lies before, the last one what lies behind
  double bins_per_angle_ = 1.0;
  std::size_t bins_ = 0;
  // Item level * bins_ + i spans 2^level bins from i on.
  std::vector<OrderRange> items_;
};

}  // namespace elbowroom::recon
