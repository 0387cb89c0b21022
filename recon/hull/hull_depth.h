// How deep in the hull a point is: the distance to the nearest point that isn't in it.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "core/ids.h"
#include "recon/hull/visual_hull.h"

namespace elbowroom::recon {

struct HullDepth {
  double depth_mm = 0.0;                                       // every nearer point is in the hull
  Eigen::Vector3d nearest_in_world = Eigen::Vector3d::Zero();  // on the hull's surface, that far away
  std::optional<core::CameraIndex> camera;                     // whose silhouette ends it; nothing: a face
};

// Nothing for a point that isn't in the hull. Where Probe() looks no farther than it is sure to, this goes
// through all edges: each spans a sector of a plane with its camera's centre, whose distance from a point has
// a closed form (docs/recovery.md), so the depth is the largest there is, but for rounding, by which it is
// short: 1e-9 of itself. Under `abstain` the border of what the camera that sees farthest around sees bounds
// it too: then it is a lower bound. Held to rays in all directions by hull_depth_test. Cost: the contours'
// edges. Thread: any.
[[nodiscard]] std::optional<HullDepth> DepthAt(const VisualHull& hull, const Eigen::Vector3d& x_in_world);

}  // namespace elbowroom::recon
