#include "recon/gauge/rod_view.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

#include "recon/calibration/lens_projection.h"

namespace elbowroom::recon {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

std::vector<std::vector<std::uint32_t>> LoopsOf(const Contour& contour) {
  std::vector<std::vector<std::uint32_t>> loops;
  std::vector<bool> seen(contour.vertices.size(), false);
  for (std::uint32_t start = 0; start < contour.vertices.size(); ++start) {
    if (seen[start]) continue;
    std::vector<std::uint32_t> loop;
    for (std::uint32_t at = start; !seen[at]; at = contour.edges[contour.edge_from[at]].to) {
      seen[at] = true;
      loop.push_back(at);
    }
    loops.push_back(std::move(loop));
  }
  return loops;
}

// Crossings lie on a row or a column of centres: one of their coordinates in the picture is whole.
bool IsOnARow(const Vector2d& pixel) {
  return std::abs(pixel.y() - std::round(pixel.y())) < std::abs(pixel.x() - std::round(pixel.x()));
}

ContourPoint PointAt(const UndistortedPlane& plane, const LensParameters& lens, const Vector2d& position) {
  const core::CameraModel& camera = plane.camera();
  const Vector2d pixel = camera.PixelFromNormalised(position / plane.focal_px());
  ContourPoint point{position, Vector2d::UnitX(), Vector2d::UnitX(), false};
  // Half a pixel from the outermost centres is the border itself.
  constexpr double kBorderPx = 0.75;
  point.is_at_border = pixel.x() < kBorderPx || pixel.y() < kBorderPx ||
                       pixel.x() > camera.width_px() - 1 - kBorderPx ||
                       pixel.y() > camera.height_px() - 1 - kBorderPx;
  const auto projected = ProjectWithDerivatives(lens, Vector3d(position.x(), position.y(), plane.focal_px()));
  if (!projected) return point;
  const Eigen::Matrix2d plane_from_pixel = projected->by_x_in_cam.leftCols<2>().inverse();
  point.step_in_plane = plane_from_pixel.col(IsOnARow(pixel) ? 0 : 1);
  return point;
}

}  // namespace

double AcrossLimit(const ContourPoint& point, const Vector2d& normal, double px) {
  // A crossing along the edge itself says where the edge is only within the pixel's size across it.
  constexpr double kLeastShare = 0.15;
  return px * std::max(std::abs(normal.dot(point.step_in_plane)), kLeastShare * point.step_in_plane.norm());
}

Vector3d RodView::SightInWorld(const Vector2d& position) const {
  const Vector3d in_cam(position.x(), position.y(), plane->focal_px());
  return (camera().cam_from_world().rotation.transpose() * in_cam).normalized();
}

RodView MakeRodView(std::shared_ptr<const UndistortedPlane> plane, const core::SoftMask& mask) {
  RodView view;
  view.plane = std::move(plane);
  view.is_ready = mask.levels.empty();
  const Contour contour = TraceContour(mask, false, *view.plane);
  const LensParameters lens = LensParametersOf(view.camera().calibration());
  view.points.reserve(contour.vertices.size());
  for (std::uint32_t i = 0; i < contour.vertices.size(); ++i) {
    view.points.push_back(PointAt(*view.plane, lens, contour.vertices[i]));
    const Vector2d tangent = SmoothTangent(contour, contour.edge_from[i]);
    if (tangent.norm() > 0.0) view.points.back().along = tangent.normalized();
  }
  view.loops = LoopsOf(contour);
  return view;
}

}  // namespace elbowroom::recon
