// Whether a part and the hull meet, for certain.
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "core/bvh.h"
#include "core/rigid_transform.h"
#include "recon/hull/visual_hull.h"

namespace elbowroom::review {

struct HullPartIntersection {
  enum class Answer {
    kApart,       // certain: no point of the part is in the hull
    kIntersects,  // certain: `common_in_world` is in both
    kOpen,        // neither, by pieces of `smallest_mm`
  };
  Answer answer = Answer::kOpen;
  Eigen::Vector3d common_in_world = Eigen::Vector3d::Zero();  // of kIntersects
};

// The part is its surface, and if it is closed what that encloses (cavities are outside). Ends with the first
// common point, or when too many pieces stay undecided. Counts its ball queries in `*queries`. The part has
// triangles. Held to dense samples by penetration_test. Thread: any.
[[nodiscard]] HullPartIntersection FindHullPartIntersection(const recon::VisualHull& hull,
                                                            const core::TriangleTree& part,
                                                            const core::RigidTransform& world_from_part,
                                                            double smallest_mm, std::int64_t* queries);

}  // namespace elbowroom::review
