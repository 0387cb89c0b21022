#include "recon/error_budget/contour_motion.h"

#include "recon/error_budget/vertex_cells.h"

namespace elbowroom::recon {
namespace {

using Eigen::Vector2d;

// A contour map's distances are exact up to here. Farther away they are lower bounds.
constexpr double kExactPx = 2.0;

}  // namespace

ContourMotion::ContourMotion(const ContourMap& before, const ContourMap& now) {
  points_.reserve(before.contour().vertices.size() + now.contour().vertices.size());
  Add(before.contour(), now);
  Add(now.contour(), before);
}

void ContourMotion::Add(const Contour& contour, const ContourMap& other) {
  const VertexCells cells(other.contour());
  for (const Vector2d& vertex : contour.vertices) {
    const double near_px = other.LabelAt(vertex, kExactPx).distance_px;
    points_.push_back({vertex, near_px < kExactPx ? near_px : cells.NearestPx(vertex)});
  }
}

double ContourMotion::MostNear(const Vector2d& position, double radius_px, double share) const {
  double most_px = 0.0;
  for (const Point& point : points_) {
    if (point.moved_px <= most_px) continue;
    const double reach_px = radius_px + share * point.moved_px;
    if ((point.position - position).squaredNorm() <= reach_px * reach_px) most_px = point.moved_px;
  }
  return most_px;
}

}  // namespace elbowroom::recon
