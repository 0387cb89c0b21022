// The paper's curtain, and the demo's hand that it is pushed into.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "core/bvh.h"
#include "core/rig.h"
#include "core/rigid_transform.h"
#include "core/soft_mask.h"
#include "core/triangle_mesh.h"
#include "recon/hull/visual_hull.h"
#include "recon/paper_methods/coverage_hull.h"
#include "recon/synthetic/solids.h"

namespace elbowroom::accuracy {

// A part of 360 x 400 mm in the plane x = 0 about the origin, of 2 * across * up triangles; as it is, the
// paper's 720 in squares of 20 mm.
[[nodiscard]] core::SharedMesh MakeCurtain(int across = 18, int up = 20);

// A scene's masks, and both hulls of them.
struct CurtainSight {
  std::shared_ptr<const core::Rig> rig;
  recon::UndistortedPlanes planes;
  std::vector<core::SoftMask> masks;
  recon::VisualHull hull;
  recon::CoverageHull textures;
};
[[nodiscard]] CurtainSight CurtainSightOf(const core::Rig& rig,
                                          const std::vector<recon::SyntheticObject>& objects);

// A point of the demo's hand, between palm and fingertips; world, mm.
inline const Eigen::Vector3d kHandMm(140.0, 10.0, 200.0);

inline constexpr double kTouchResolutionMm = 0.1;  // of what counts as a touch

// The curtain in front of `center`, coming along its x axis, `depth_mm` farther than where it first touches.
// Throws: core::PreconditionError if it doesn't touch when it is at the center.
[[nodiscard]] core::RigidTransform PushedIn(const recon::VisualHull& hull, const core::TriangleTree& part,
                                            const Eigen::Matrix3d& world_from_part,
                                            const Eigen::Vector3d& center, double depth_mm);

}  // namespace elbowroom::accuracy
