// How far a part is from real objects that are known exactly: the truth of a verdict.
#pragma once

#include <span>

#include "core/rigid_transform.h"
#include "core/triangle_mesh.h"
#include "recon/synthetic/solids.h"

namespace elbowroom::oracles {

// The least signed distance from a point of the part's surface to the solids, in mm: above 0 how far apart
// they are, below 0 how deep the surface's deepest point is in a solid (in their union it may be deeper).
// Where a solid stands wholly inside a closed part and touches no face, minus their distance. Never below the
// exact value, and above it by `tolerance_mm` at most; from `far_mm` on, only that it is as far as that.
//
// Branch and bound over pieces of triangles: a distance changes by no more than the way. Solids and part in
// world. Held to closed forms and to dense samples by solid_distance_test. Throws: PreconditionError without
// solids or triangles, for more than 64 solids, or for a tolerance that isn't positive.
[[nodiscard]] double SolidDistanceMm(const core::TriangleMesh& part,
                                     const core::RigidTransform& world_from_part,
                                     std::span<const recon::Solid> solids, double tolerance_mm,
                                     double far_mm);

}  // namespace elbowroom::oracles
