// How deep in the hull a point is: the distance to the nearest point that isn't in it.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "core/ids.h"
#include "recon/hull/visual_hull_declared.h"

namespace elbowroom::recon {

struct HullDepth {
  double depth_mm = 0.0;                                       // all points nearer than this are in the hull
  Eigen::Vector3d nearest_in_world = Eigen::Vector3d::Zero();  // the point of the hull's surface at depth_mm
  // The camera whose silhouette the nearest point is on; nothing: it is on a face of the workspace.
  std::optional<core::CameraIndex> camera;
};

// Nothing for a point that isn't in the hull. VisualHull::Probe gives a radius that is certain but may be
// short; this gives the depth itself. It goes through all edges of all contours: an edge and its camera's
// centre span a sector of a plane, and the distance from a point to such a sector has a closed form
// (docs/recovery.md). The least of these distances is the depth; it is made shorter by 1e-9 of itself to stay
// below it under rounding. Under `abstain` the result is a lower bound: the border of what a camera sees
// counts as surface, for the camera whose border is farthest away. Held to rays in all directions by
// hull_depth_test. Cost: linear in the number of edges. Thread: any.
[[nodiscard]] std::optional<HullDepth> DepthAt(const VisualHull& hull, const Eigen::Vector3d& x_in_world);

}  // namespace elbowroom::recon
