// The paper's curtain, a panel of triangles as small as those of a tabletop object, and the demo's hand that
// both are pushed into.
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

// The curtain: 720 triangles in the plane x = 0 about the origin, the bounding box of each 75 x 30 mm. The
// paper ("Accuracy" of the collision detection) has 720 triangles, viewports of 10 x 10 and a resolution of
// 0.75 cm x 0.3 cm. That they are 12 cells across and 30 up, 900 x 900 mm together, is our choice: so it fits
// into the paper's volume of 5' x 4' x 3'.
[[nodiscard]] core::SharedMesh MakeCurtain();

// A panel of 360 x 400 mm in the plane x = 0 about the origin, of 2 * across * up triangles; as it is, 720 in
// squares of 20 mm: the paper's "typical tabletop objects had triangles less than 2 cm".
[[nodiscard]] core::SharedMesh MakeTabletopPanel(int across = 18, int up = 20);

// A scene's masks, and both hulls of them.
struct HandSight {
  std::shared_ptr<const core::Rig> rig;
  recon::UndistortedPlanes planes;
  std::vector<core::SoftMask> masks;
  recon::VisualHull hull;
  recon::CoverageHull textures;
};
[[nodiscard]] HandSight HandSightOf(const core::Rig& rig, const std::vector<recon::SyntheticObject>& objects);

// A point of the demo's hand, between palm and fingertips; world, mm.
inline const Eigen::Vector3d kHandMm(140.0, 10.0, 200.0);

inline constexpr double kTouchResolutionMm = 0.1;  // of what counts as a touch

// The part in front of `center`, coming along its x axis, `depth_mm` farther than where it first touches the
// hull, wherever that is. Throws: core::PreconditionError if it doesn't touch when it is at the center.
[[nodiscard]] core::RigidTransform PushedIn(const recon::VisualHull& hull, const core::TriangleTree& part,
                                            const Eigen::Matrix3d& world_from_part,
                                            const Eigen::Vector3d& center, double depth_mm);

}  // namespace elbowroom::accuracy
