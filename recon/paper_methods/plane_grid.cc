#include "recon/paper_methods/plane_grid.h"

#include <algorithm>

#include "core/error.h"

namespace elbowroom::recon {

using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

// The place of a point in the camera's picture plane, homogeneous; any point has one, also behind the camera.
Vector3d PlaceOf(const core::CameraModel& camera, const Vector3d& x_in_cam) {
  const Vector2d across_mm = x_in_cam.head<2>();
  const double from_axis_mm = across_mm.norm(), z_mm = x_in_cam.z(), domain = camera.max_radius();
  if (z_mm > 0.0 && from_axis_mm <= domain * z_mm)
    return z_mm * camera.PixelFromNormalised(across_mm / z_mm).homogeneous();
  const Vector2d center_px = camera.PixelFromNormalised(Vector2d::Zero());
  Vector2d from_center = Vector2d::Zero();  // of the picture, in px times mm
  if (from_axis_mm > 0.0)
    from_center =
        from_axis_mm / domain * (camera.PixelFromNormalised(domain / from_axis_mm * across_mm) - center_px);
  const Vector2d place = z_mm * center_px + from_center;
  return {place.x(), place.y(), z_mm};
}

}  // namespace

GridTriangle GridTriangle::CountedFrom(const Vector2d& place_px) const {
  const auto counted = [&](const Vector3d& h) {
    return Vector3d(h.x() - place_px.x() * h.z(), h.y() - place_px.y() * h.z(), h.z());
  };
  return {counted(origin), counted(along_x), counted(along_y)};
}

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
  std::vector<std::optional<Vector3d>> positions(rays_.size());
  for (std::size_t i = 0; i < rays_.size(); ++i) {
    if (rays_[i])
      positions[i] = PlaceOf(camera.model, camera.cam_from_view * (depth_mm * rays_[i]->homogeneous()));
  }
  std::vector<std::optional<GridTriangle>> result(triangles());
  for (std::size_t i = 0; i < result.size(); ++i) {
    const auto nodes = NodesOf(i);
    const auto at = [&](std::size_t corner) -> const std::optional<Vector3d>& {
      return positions[NodeIndex(nodes[corner].x(), nodes[corner].y())];
    };
    if (!at(0) || !at(1) || !at(2)) continue;
    // The second corner is beside the first, the third above or below it; the other half runs backwards.
    const double sense = i % 2 == 0 ? 1.0 : -1.0;
    GridTriangle triangle;
    triangle.along_x = sense * (*at(1) - *at(0)) / cell_px_.x();
    triangle.along_y = sense * (*at(2) - *at(0)) / cell_px_.y();
    const Vector2d corner = NodePx(nodes[0].x(), nodes[0].y());
    triangle.origin = *at(0) - corner.x() * triangle.along_x - corner.y() * triangle.along_y;
    result[i] = triangle;
  }
  return result;
}

}  // namespace elbowroom::recon
