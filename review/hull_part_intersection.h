// Whether a part and the hull meet, for certain.
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "core/bvh.h"
#include "core/rigid_transform.h"
#include "recon/hull/visual_hull_declared.h"

namespace elbowroom::review {

struct HullPartIntersection {
  enum class Answer {
    kApart,       // certain: no point of the part is in the hull
    kIntersects,  // certain: `common_in_world` is in both
    kOpen,        // neither is certain, with pieces of `smallest_mm`
  };
  Answer answer = Answer::kOpen;
  Eigen::Vector3d common_in_world = Eigen::Vector3d::Zero();  // only for kIntersects
};

// The part is its surface and, if that is closed, what it encloses (cavities are outside). The search ends
// with the first common point, or when too many pieces stay undecided. Adds its ball queries to `*queries`.
// The part must have triangles. Held to dense samples by penetration_test. Thread: any.
[[nodiscard]] HullPartIntersection FindHullPartIntersection(const recon::VisualHull& hull,
                                                            const core::TriangleTree& part,
                                                            const core::RigidTransform& world_from_part,
                                                            double smallest_mm, std::int64_t* queries);

}  // namespace elbowroom::review
