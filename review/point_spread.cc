#include "review/point_spread.h"

#include <Eigen/Core>
#include <algorithm>
#include <limits>

#include "core/error.h"

namespace elbowroom::review {

std::vector<core::ContactPoint> SpreadEvenly(std::span<const core::ContactPoint> points, std::size_t count) {
  core::Require(count > 0, "at least one point is kept");
  if (points.size() <= count) return {points.begin(), points.end()};
  // Single precision relative to the first point is enough: it only decides which of two points is farther.
  using Row = Eigen::Array<float, 1, Eigen::Dynamic>;
  const auto size = static_cast<Eigen::Index>(points.size());
  Eigen::Array<float, 3, Eigen::Dynamic, Eigen::RowMajor> at(3, size);
  for (Eigen::Index i = 0; i < size; ++i)
    at.col(i) = (points[static_cast<std::size_t>(i)].position_in_world_mm - points[0].position_in_world_mm)
                    .cast<float>();
  Row nearest = Row::Constant(size, std::numeric_limits<float>::infinity());
  Row nearest_kept = Row::Zero(size);
  Row squared(size);
  std::vector<core::ContactPoint> kept;
  Eigen::Index next = 0;
  while (kept.size() < count) {
    squared = (at.row(0) - at(0, next)).square() + (at.row(1) - at(1, next)).square() +
              (at.row(2) - at(2, next)).square();
    nearest_kept = (squared < nearest).select(static_cast<float>(kept.size()), nearest_kept);
    nearest = nearest.min(squared);
    kept.push_back(points[static_cast<std::size_t>(next)]);
    kept.back().area_mm2 = 0.0;
    next = std::find(nearest.begin(), nearest.end(), nearest.maxCoeff()) - nearest.begin();
  }
  for (std::size_t i = 0; i < points.size(); ++i)
    kept[static_cast<std::size_t>(nearest_kept[static_cast<Eigen::Index>(i)])].area_mm2 += points[i].area_mm2;
  return kept;
}

}  // namespace elbowroom::review
