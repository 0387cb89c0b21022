#include "recon/paper_methods/plane_grid.h"

#include <algorithm>

#include "core/error.h"

namespace elbowroom::recon {

using Eigen::Vector2d;

PlaneGrid::PlaneGrid(const core::CameraModel& view, int cells)
    : cells_(cells), cell_px_(Vector2d(view.width_px(), view.height_px()) / cells) {
  core::Require(cells >= 1 && cells <= 1024, "an undistortion grid has 1 to 1024 cells a side");
  for (int row = 0; row <= cells; ++row)
    for (int column = 0; column <= cells; ++column)
      rays_.push_back(view.NormalisedFromPixel(NodePx(column, row)));
}

// The grid spans the picture with its outer half pixels.
Vector2d PlaneGrid::NodePx(int column, int row) const {
  return Vector2d(column, row).cwiseProduct(cell_px_) - Vector2d::Constant(0.5);
}

std::size_t PlaneGrid::TriangleOf(int x, int y) const {
  const Vector2d in_cells = (Vector2d(x, y) + Vector2d::Constant(0.5)).cwiseQuotient(cell_px_);
  const int column = std::clamp(static_cast<int>(in_cells.x()), 0, cells_ - 1),
            row = std::clamp(static_cast<int>(in_cells.y()), 0, cells_ - 1);
  const bool is_lower_right = in_cells.x() - column + in_cells.y() - row >= 1.0;
  return 2 * static_cast<std::size_t>(row * cells_ + column) + (is_lower_right ? 1 : 0);
}

std::array<Eigen::Vector2i, 3> PlaneGrid::NodesOf(std::size_t triangle) const {
  const auto cell = static_cast<int>(triangle / 2);
  const int column = cell % cells_, row = cell / cells_;
  if (triangle % 2 == 0) return {{{column, row}, {column + 1, row}, {column, row + 1}}};
  return {{{column + 1, row + 1}, {column, row + 1}, {column + 1, row}}};
}

std::array<Vector2d, 3> PlaneGrid::CornersOf(std::size_t triangle) const {
  const auto nodes = NodesOf(triangle);
  return {NodePx(nodes[0].x(), nodes[0].y()), NodePx(nodes[1].x(), nodes[1].y()),
          NodePx(nodes[2].x(), nodes[2].y())};
}

std::vector<std::optional<GridTriangle>> PlaneGrid::PositionsOf(const SweepCamera& camera,
                                                                double depth_mm) const {
  std::vector<std::optional<Vector2d>> positions(rays_.size());
  for (std::size_t i = 0; i < rays_.size(); ++i)
    if (rays_[i])
      positions[i] = camera.model.ProjectInCam(camera.cam_from_view * (depth_mm * rays_[i]->homogeneous()));
  std::vector<std::optional<GridTriangle>> result(triangles());
  for (std::size_t i = 0; i < result.size(); ++i) {
    const auto nodes = NodesOf(i);
    const auto at = [&](std::size_t corner) -> const std::optional<Vector2d>& {
      return positions[NodeIndex(nodes[corner].x(), nodes[corner].y())];
    };
    if (!at(0) || !at(1) || !at(2)) continue;
    // The second corner is beside the first, the third above or below it; the other half runs backwards.
    const double sense = i % 2 == 0 ? 1.0 : -1.0;
    GridTriangle triangle;
    triangle.along_x = sense * (*at(1) - *at(0)) / cell_px_.x();
    triangle.along_y = sense * (*at(2) - *at(0)) / cell_px_.y();
    const Vector2d corner = NodePx(nodes[0].x(), nodes[0].y());
    triangle.origin_px = *at(0) - corner.x() * triangle.along_x - corner.y() * triangle.along_y;
    result[i] = triangle;
  }
  return result;
}

}  // namespace elbowroom::recon
