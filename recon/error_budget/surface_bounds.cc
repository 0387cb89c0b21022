#include "recon/error_budget/surface_bounds.h"

#include <cmath>

#include "recon/error_budget/normal_cone.h"
#include "recon/hull/visual_hull.h"

namespace elbowroom::recon {
namespace {

// A contour this close to a point bounds the hull there. The point is found by bisection.
constexpr double kBoundingPx = 1.0;
constexpr double kOnFaceMm = 1e-3;
// The contours' normals are good to some degrees, and a search's witness points to its tolerance. Where the
// direction is farther than this from the normals' cone, they don't explain it.
constexpr double kMostResidual = 0.5;

}  // namespace

std::vector<SurfaceBound> SurfaceBoundsAt(const VisualHull& hull, const Eigen::Vector3d& x_in_world) {
  std::vector<SurfaceBound> bounds;
  for (const NearEdge& edge : NearEdges(hull, x_in_world)) {
    if (edge.distance_px > kBoundingPx) continue;
    bounds.push_back({NormalOf(hull, edge).in_world, edge});
  }
  const Eigen::AlignedBox3d& workspace_mm = hull.rig().workspace_mm;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {-1.0, 1.0}) {
      const double face_mm = sign < 0.0 ? workspace_mm.min()[axis] : workspace_mm.max()[axis];
      if (std::abs(x_in_world[axis] - face_mm) > kOnFaceMm) continue;
      bounds.push_back({sign * Eigen::Vector3d::Unit(axis), std::nullopt});
    }
  }
  return bounds;
}

std::optional<std::vector<double>> SharesOf(std::span<const Eigen::Vector3d> normals_in_world,
                                            const Eigen::Vector3d& towards_part) {
  ConeWeights cone = WeightsInCone(normals_in_world, towards_part);
  if (!(cone.residual <= kMostResidual)) return std::nullopt;
  // The direction's nearest one in the cone, made a unit vector again.
  const double scale = 1.0 / std::sqrt(1.0 - cone.residual * cone.residual);
  for (double& weight : cone.weights) weight *= scale;
  return std::move(cone.weights);
}

}  // namespace elbowroom::recon
