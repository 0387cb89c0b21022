// The orders between which a camera's object can be, for any range of angles.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "recon/exact_view/cast_intervals.h"

namespace elbowroom::recon {

// Gives the union of the object ranges of all intervals that a range of angles touches. It is a sparse table
// over bins of angles: an answer joins two items, however wide the range is. Angles are rounded outwards to
// whole bins, so that an answer is never less than the union over the angles themselves. Immutable.
class ObjectRangeTable {
 public:
  ObjectRangeTable() = default;
  // `begins` as CastIntervals::begins, one range an interval.
  ObjectRangeTable(std::span<const float> begins, std::span<const OrderRange> ranges);

  [[nodiscard]] OrderRange Over(double least_angle, double most_angle) const;

 private:
  [[nodiscard]] std::size_t BinOf(double angle) const;

  double first_angle_ = 0.0;  // bin 1 begins here; bin 0 takes all angles before, the last bin all behind
  double bins_per_angle_ = 1.0;
  std::size_t bins_ = 0;
  // Item level * bins_ + i spans 2^level bins from i on.
  std::vector<OrderRange> items_;
};

}  // namespace elbowroom::recon
