// The surfaces that bound the hull at a point, and how much each counts in a direction.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "recon/hull/hull_edges.h"
#include "recon/hull/visual_hull_declared.h"

namespace elbowroom::recon {

// A silhouette's cone, or a face of the workspace.
struct SurfaceBound {
  Eigen::Vector3d normal_in_world;  // unit, out of the hull
  std::optional<NearEdge> edge;     // of the silhouette; nothing: a face of the workspace
};

// Those whose contour passes within a pixel of the point's projection, and the faces that the point is on.
[[nodiscard]] std::vector<SurfaceBound> SurfaceBoundsAt(const VisualHull& hull,
                                                        const Eigen::Vector3d& x_in_world);

// The multipliers, one a normal, of the distance from the hull to a point in the direction `towards_part`
// (unit): how much the distance shrinks when the surface moves outwards by 1 mm (docs/error_budget.md).
// Nothing where the normals don't explain the direction, as between a search's bounds.
[[nodiscard]] std::optional<std::vector<double>> SharesOf(std::span<const Eigen::Vector3d> normals_in_world,
                                                          const Eigen::Vector3d& towards_part);

}  // namespace elbowroom::recon
