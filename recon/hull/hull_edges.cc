#include "recon/hull/hull_edges.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "recon/contours/silhouette.h"
#include "recon/hull/visual_hull.h"

namespace elbowroom::recon {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int kFitVertices = 2 * kFitReach;

// The vertices around an edge, in the contour's order; nothing if the loop has fewer.
std::optional<std::array<std::uint32_t, kFitVertices>> VerticesAround(const Contour& contour,
                                                                      std::uint32_t edge) {
  std::array<std::uint32_t, kFitVertices> vertices{};
  std::uint32_t before = contour.edges[edge].from, after = contour.edges[edge].to;
  for (std::size_t i = 0; i < kFitReach; ++i) {
    vertices[kFitReach - 1 - i] = before;
    vertices[kFitReach + i] = after;
    before = contour.edges[contour.edge_to[before]].from;
    after = contour.edges[contour.edge_from[after]].to;
  }
  std::array<std::uint32_t, kFitVertices> sorted = vertices;
  std::ranges::sort(sorted);
  if (std::ranges::adjacent_find(sorted) != sorted.end()) return std::nullopt;
  return vertices;
}

// The normal of the plane through the camera's centre and a line of the picture: unit, away from the object.
// The object is where cross(tangent, p - position) > 0, or (position, f) x (tangent, 0) . x > 0.
Vector3d OutwardInCam(const Vector2d& position, const Vector2d& tangent, double focal_px) {
  const Vector3d inward =
      Vector3d(position.x(), position.y(), focal_px).cross(Vector3d(tangent.x(), tangent.y(), 0.0));
  return -inward.normalized();
}

}  // namespace

std::optional<FittedTangent> FitTangent(const Contour& contour, std::uint32_t edge,
                                        const Vector2d& position) {
  const auto vertices = VerticesAround(contour, edge);
  if (!vertices) return std::nullopt;
  const Vector2d chord = contour.vertices[vertices->back()] - contour.vertices[vertices->front()];
  if (!(chord.norm() > 0.0)) return std::nullopt;
  const Vector2d along = chord.normalized(), across(-along.y(), along.x());
  // height = a + b s + c s^2, by the normal equations: least squares over the vertices.
  Eigen::Matrix<double, kFitVertices, 3> powers;
  Eigen::Matrix<double, kFitVertices, 1> heights;
  for (Eigen::Index i = 0; i < kFitVertices; ++i) {
    const Vector2d offset = contour.vertices[(*vertices)[static_cast<std::size_t>(i)]] - position;
    const double s = offset.dot(along);
    powers.row(i) << 1.0, s, s * s;
    heights[i] = offset.dot(across);
  }
  const Eigen::Matrix3d squares = powers.transpose() * powers;
  if (!(squares.determinant() > 0.0)) return std::nullopt;
  const Eigen::Matrix<double, 3, kFitVertices> solver = squares.inverse() * powers.transpose();
  const Vector3d fit = solver * heights;
  FittedTangent fitted;
  fitted.tangent = (along + fit[1] * across).normalized();
  fitted.gain_per_px = solver.row(1).lpNorm<1>();
  fitted.residual_px = (heights - powers * fit).lpNorm<Eigen::Infinity>();
  fitted.curvature_per_px = std::abs(2.0 * fit[2]) / std::pow(1.0 + fit[1] * fit[1], 1.5);
  return fitted;
}

std::optional<NearEdge> NearEdgeOf(const VisualHull& hull, core::CameraIndex camera,
                                   const Vector3d& x_in_world) {
  const Vector3d x_in_cam = hull.rig().cameras[camera].cam_from_world() * x_in_world;
  if (!(x_in_cam.z() > 0.0)) return std::nullopt;
  const double focal_px = hull.silhouettes()[camera]->plane().focal_px();
  const Vector2d position = x_in_cam.head<2>() * (focal_px / x_in_cam.z());
  const ContourMap& labels = hull.silhouettes()[camera]->labels();
  const std::optional<std::uint32_t> edge = labels.NearestEdge(position);
  if (!edge) return std::nullopt;
  return NearEdge{camera, *edge, position, DistanceToEdge(labels.contour(), *edge, position),
                  x_in_cam.z() / focal_px};
}

std::vector<NearEdge> NearEdges(const VisualHull& hull, const Vector3d& x_in_world) {
  std::vector<NearEdge> near;
  for (std::size_t i = 0; i < hull.silhouettes().size(); ++i)
    if (const std::optional<NearEdge> edge = NearEdgeOf(hull, i, x_in_world)) near.push_back(*edge);
  return near;
}

double LargestPixelMm(const VisualHull& hull, const Vector3d& x_in_world) {
  const core::Rig& rig = hull.rig();
  double largest_mm = 0.0;
  for (std::size_t i = 0; i < rig.cameras.size(); ++i) {
    const double depth_mm = (rig.cameras[i].cam_from_world() * x_in_world).z();
    largest_mm = std::max(largest_mm, depth_mm / hull.silhouettes()[i]->plane().focal_px());
  }
  return largest_mm;
}

EdgeNormal NormalOf(const VisualHull& hull, const NearEdge& edge) {
  const double focal_px = hull.silhouettes()[edge.camera]->plane().focal_px();
  const Contour& contour = hull.silhouettes()[edge.camera]->labels().contour();
  const std::optional<FittedTangent> fitted = FitTangent(contour, edge.edge, edge.position);
  EdgeNormal normal;
  normal.stretch = Vector3d(edge.position.x(), edge.position.y(), focal_px).norm() / focal_px;
  Vector3d in_cam;
  if (fitted) {
    in_cam = OutwardInCam(edge.position, fitted->tangent, focal_px);
    normal.gain_per_px = fitted->gain_per_px;
    normal.residual_px = fitted->residual_px;
    normal.curvature_per_px = fitted->curvature_per_px;
  } else {
    in_cam = OutwardNormalInCam(contour, edge.edge, focal_px);
    normal.curvature_per_px = std::numbers::pi;  // a loop of a few edges: its normal may be anything
  }
  normal.in_world = hull.rig().cameras[edge.camera].cam_from_world().rotation.transpose() * in_cam;
  return normal;
}

double EdgeNormal::UncertaintyRad(double silhouette_px, double along_px) const {
  const double turn_rad = std::atan(gain_per_px * (silhouette_px + residual_px));
  return std::min(stretch * (turn_rad + curvature_per_px * along_px), std::numbers::pi);
}

}  // namespace elbowroom::recon
