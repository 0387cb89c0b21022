#include "review/point_spread.h"

#include <limits>

#include "core/error.h"

namespace elbowroom::review {

std::vector<core::ContactPoint> SpreadEvenly(std::vector<core::ContactPoint> points, std::size_t count) {
  core::Require(count > 0, "at least one point is kept");
  if (points.size() <= count) return points;
  std::vector<double> nearest(points.size(), std::numeric_limits<double>::infinity());
  std::vector<std::size_t> nearest_kept(points.size(), 0);
  std::vector<core::ContactPoint> kept;
  std::size_t next = 0;
  while (kept.size() < count) {
    kept.push_back(points[next]);
    kept.back().area_mm2 = 0.0;
    const Eigen::Vector3d latest = points[next].position_in_world_mm;
    double farthest = -1.0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double distance = (points[i].position_in_world_mm - latest).squaredNorm();
      if (distance < nearest[i]) {
        nearest[i] = distance;
        nearest_kept[i] = kept.size() - 1;
      }
      if (nearest[i] > farthest) {
        farthest = nearest[i];
        next = i;
      }
    }
  }
  for (std::size_t i = 0; i < points.size(); ++i) kept[nearest_kept[i]].area_mm2 += points[i].area_mm2;
  return kept;
}

}  // namespace elbowroom::review
