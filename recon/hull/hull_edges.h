// Which silhouettes' edges a point of the hull's surface is on, and how sure their normals are.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/ids.h"
#include "recon/contours/contour.h"
#include "recon/hull/visual_hull_declared.h"

namespace elbowroom::recon {

// A contour's direction at a position on it: that of the parabola that fits the vertices around it best.
struct FittedTangent {
  Eigen::Vector2d tangent = Eigen::Vector2d::UnitX();  // unit, the object to the left as of ContourEdge
  // If each vertex moves by up to d px, the tangent turns by no more than atan(d * gain_per_px).
  double gain_per_px = 0.0;
  double residual_px = 0.0;       // of the vertex that fits worst
  double curvature_per_px = 0.0;  // rad by which it turns in a pixel along it
};

// Fitted to kFitReach vertices before and after the edge; nothing for a loop with fewer, or for vertices that
// define no parabola. A chord between two vertices has the direction of the contour at its middle, which
// isn't the position; on a curve it is off by what the curve turns in between (hull_edges_test).
inline constexpr int kFitReach = 4;
[[nodiscard]] std::optional<FittedTangent> FitTangent(const Contour& contour, std::uint32_t edge,
                                                      const Eigen::Vector2d& position);

// A camera's edge within two cells of where the point falls in its picture.
struct NearEdge {
  core::CameraIndex camera = 0;
  std::uint32_t edge = 0;
  Eigen::Vector2d position = Eigen::Vector2d::Zero();  // of the point in the picture plane
  double distance_px = 0.0;                            // from the edge
  double px_mm = 0.0;  // the width of a pixel there, parallel to the picture plane
};

[[nodiscard]] std::optional<NearEdge> NearEdgeOf(const VisualHull& hull, core::CameraIndex camera,
                                                 const Eigen::Vector3d& x_in_world);

// Those of all cameras.
[[nodiscard]] std::vector<NearEdge> NearEdges(const VisualHull& hull, const Eigen::Vector3d& x_in_world);

// The width of a pixel at a point, mm; the largest over the cameras that look towards it, 0 if none does.
[[nodiscard]] double LargestPixelMm(const VisualHull& hull, const Eigen::Vector3d& x_in_world);

struct EdgeNormal {
  Eigen::Vector3d in_world = Eigen::Vector3d::UnitZ();  // unit, away from the object
  double gain_per_px = 0.0;                             // this and the next two: FittedTangent's
  double residual_px = 0.0;
  double curvature_per_px = 0.0;
  double stretch = 1.0;  // the factor by which an angle in the picture grows in space, at most

  // The most by which the normal may be turned, for vertices off by up to `silhouette_px` and a position off
  // by up to `along_px` (docs/recovery.md).
  [[nodiscard]] double UncertaintyRad(double silhouette_px, double along_px) const;
};

[[nodiscard]] EdgeNormal NormalOf(const VisualHull& hull, const NearEdge& edge);

}  // namespace elbowroom::recon
