#include "recon/error_budget/vertex_cells.h"

#include <algorithm>
#include <cmath>

#include "core/infinity.h"

namespace elbowroom::recon {
namespace {

using Eigen::Vector2d;

constexpr double kCellPx = 16.0;

}  // namespace

VertexCells::VertexCells(const Contour& contour) {
  for (const Vector2d& vertex : contour.vertices) bounds_.extend(vertex);
  if (contour.vertices.empty()) return;
  across_ = Eigen::Vector2i((bounds_.sizes() / kCellPx).array().floor().cast<int>() + 1);
  cells_.resize(static_cast<std::size_t>(across_.prod()));
  for (const Vector2d& vertex : contour.vertices) cells_[Index(CellOf(vertex))].push_back(vertex);
}

double VertexCells::NearestPx(const Vector2d& position) const {
  if (cells_.empty()) return core::kInfinity;
  const Eigen::Vector2i middle = CellOf(position);
  const double outside_px = std::sqrt(bounds_.squaredExteriorDistance(position));
  double nearest_px = core::kInfinity;
  // Cells of ring k are k - 1 cells or more from the place in the bounds that is nearest to the position, and
  // no nearer to the position itself.
  for (int ring = 0; ring <= across_.maxCoeff(); ++ring) {
    if (std::max(outside_px, (ring - 1) * kCellPx) > nearest_px) break;
    VisitRing(middle, ring, position, &nearest_px);
  }
  return nearest_px;
}

Eigen::Vector2i VertexCells::CellOf(const Vector2d& position) const {
  const Vector2d at = (position - bounds_.min()) / kCellPx;
  return at.cwiseMax(0.0).cwiseMin((across_.array() - 1).matrix().cast<double>()).cast<int>();
}

std::size_t VertexCells::Index(const Eigen::Vector2i& cell) const {
  return static_cast<std::size_t>(cell.y()) * static_cast<std::size_t>(across_.x()) +
         static_cast<std::size_t>(cell.x());
}

void VertexCells::VisitRing(const Eigen::Vector2i& middle, int ring, const Vector2d& position,
                            double* nearest_px) const {
  for (int y = std::max(middle.y() - ring, 0); y <= std::min(middle.y() + ring, across_.y() - 1); ++y) {
    const bool is_whole_row = ring == 0 || std::abs(y - middle.y()) == ring;
    for (int x = middle.x() - ring; x <= middle.x() + ring; x += is_whole_row ? 1 : 2 * ring) {
      if (x < 0 || x >= across_.x()) continue;
      for (const Vector2d& vertex : cells_[Index({x, y})])
        *nearest_px = std::min(*nearest_px, (vertex - position).norm());
    }
  }
}

}  // namespace elbowroom::recon
