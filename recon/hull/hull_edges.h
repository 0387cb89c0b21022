// Which silhouettes' edges a point of the hull's surface is on, and how sure their normals are.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/ids.h"
#include "recon/contours/contour.h"
#include "recon/hull/visual_hull.h"

namespace elbowroom::recon {

// A contour's direction at a position on it: that of the parabola that fits its vertices around best.
struct FittedTangent {
  Eigen::Vector2d tangent = Eigen::Vector2d::UnitX();  // unit, the object to the left as of ContourEdge
  // Were each vertex moved by up to 1 px, the tangent would turn by no more than atan of this many radians.
  double gain_per_px = 0.0;
  double residual_px = 0.0;       // of the vertex that fits worst
  double curvature_per_px = 0.0;  // turned in a pixel along it, rad
};

// Fitted to kFitReach vertices before and after the edge; nothing for a loop with fewer. A chord between
// vertices isn't centred on the position, and a curve's tangent is off by as much as that turns
// (hull_edges_test).
inline constexpr int kFitReach = 4;
[[nodiscard]] std::optional<FittedTangent> FitTangent(const Contour& contour, std::uint32_t edge,
                                                      const Eigen::Vector2d& position);

// A camera's edge within two cells of where the point falls in its picture.
struct NearEdge {
  core::CameraIndex camera = 0;
  std::uint32_t edge = 0;
  Eigen::Vector2d position = Eigen::Vector2d::Zero();  // of the point in the picture plane
  double distance_px = 0.0;                            // from the edge
  double px_mm = 0.0;                                  // what a pixel is there, across the sight ray
};

// One a camera at most.
[[nodiscard]] std::vector<NearEdge> NearEdges(const VisualHull& hull, const Eigen::Vector3d& x_in_world);

// The width of a pixel at a point, mm; the largest over the cameras that look towards it, 0 if none does.
[[nodiscard]] double LargestPixelMm(const VisualHull& hull, const Eigen::Vector3d& x_in_world);

struct EdgeNormal {
  Eigen::Vector3d in_world = Eigen::Vector3d::UnitZ();  // unit, away from the object
  double gain_per_px = 0.0;                             // this and the next two: FittedTangent's
  double residual_px = 0.0;
  double curvature_per_px = 0.0;
  double stretch = 1.0;  // of angles on their way from the picture into space, at most

  // How far it may be turned, for vertices off by up to `silhouette_px` and a position off by up to
  // `along_px` (docs/recovery.md).
  [[nodiscard]] double UncertaintyRad(double silhouette_px, double along_px) const;
};

[[nodiscard]] EdgeNormal NormalOf(const VisualHull& hull, const NearEdge& edge);

}  // namespace elbowroom::recon
