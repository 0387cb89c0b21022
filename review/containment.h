// Real matter that stands inside a closed part without touching any of its faces.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>

#include "core/bvh.h"
#include "core/rigid_transform.h"
#include "recon/visual_hull.h"

namespace elbowroom::review {

// True if the point is inside a closed mesh: a ray from it crosses the surface an odd number of times.
// Cavities of the mesh are outside. x_in_part in the mesh's frame.
[[nodiscard]] bool IsInsideClosedMesh(const core::TriangleTree& part, const Eigen::Vector3d& x_in_part);

// A point of the hull inside a closed part no face of which the hull reaches; nothing if there is none, or
// the part isn't closed. An octree over the part's bounds is refined by the ball query down to `cell_mm`: a
// hull thinner than that may be missed. Counts its queries in `*queries`.
[[nodiscard]] std::optional<Eigen::Vector3d> FindHullInside(const recon::VisualHull& hull,
                                                            const core::TriangleTree& part,
                                                            const core::RigidTransform& world_from_part,
                                                            double cell_mm, std::int64_t* queries);

}  // namespace elbowroom::review
