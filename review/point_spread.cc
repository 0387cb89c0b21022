#include "review/point_spread.h"

#include <Eigen/Core>
#include <algorithm>
#include <limits>
#include <utility>

#include "core/error.h"

namespace elbowroom::review {

std::vector<core::ContactPoint> SpreadEvenly(std::span<const core::ContactPoint> points, std::size_t count) {
  SpreadScratch own;
  return SpreadEvenly(points, count, &own);
}

std::vector<core::ContactPoint> SpreadEvenly(std::span<const core::ContactPoint> points, std::size_t count,
                                             SpreadScratch* scratch) {
  core::Require(count > 0, "at least one point is kept");
  std::vector<core::ContactPoint> kept = std::move(scratch->kept);
  if (points.size() <= count) {
    kept.assign(points.begin(), points.end());
    return kept;
  }
  kept.clear();
  // Single precision relative to the first point is enough: it only decides which of two points is farther.
  using Rows = Eigen::Map<Eigen::Array<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>;
  constexpr Eigen::Index kRows = 6;
  const auto size = static_cast<Eigen::Index>(points.size());
  scratch->rows.resize(static_cast<std::size_t>(kRows * size));
  Rows rows(scratch->rows.data(), kRows, size);
  auto at = rows.topRows<3>();
  for (Eigen::Index i = 0; i < size; ++i)
    at.col(i) = (points[static_cast<std::size_t>(i)].position_in_world_mm - points[0].position_in_world_mm)
                    .cast<float>();
  auto nearest = rows.row(3), nearest_kept = rows.row(4), squared = rows.row(5);
  nearest.setConstant(std::numeric_limits<float>::infinity());
  nearest_kept.setZero();
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
