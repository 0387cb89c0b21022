// Hulls that are hard to judge and to draw: what a participant's body does to a silhouette.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <memory>
#include <string_view>
#include <vector>

#include "core/rig.h"
#include "core/soft_mask.h"
#include "recon/hull/visual_hull.h"
#include "recon/synthetic/solids.h"
#include "recon/synthetic/view_scene.h"

namespace elbowroom::accuracy {

enum class HardHull {
  kFist,           // a closed hand and its forearm: round, with creases
  kSpreadFingers,  // thin bars side by side, which hide one another
  kReachingHand,   // a stretched hand and its forearm in one line, as they reach into a bore
  kTwoPeople,      // two large bodies, each with an arm stretched out
};
inline constexpr std::array kHardHulls = {HardHull::kFist, HardHull::kSpreadFingers, HardHull::kReachingHand,
                                          HardHull::kTwoPeople};

[[nodiscard]] std::string_view ToString(HardHull hull);  // "fist", "spread fingers", ...

// World, in the workspace of FourCameraRig() and EightCameraRig(). `thicker_mm` is added to all radii.
[[nodiscard]] recon::SyntheticObject ObjectOf(HardHull hull, double thicker_mm = 0.0);

// A hull, and where its surface is.
struct SeenHull {
  HardHull which = HardHull::kFist;
  std::shared_ptr<const recon::VisualHull> hull;
  std::vector<Eigen::Vector3d> surface_mm;              // vertices of its mesh, world
  Eigen::AlignedBox3d box_mm;                           // around them
  Eigen::Vector3d middle_mm = Eigen::Vector3d::Zero();  // the deepest of seeded points of the hull
};

[[nodiscard]] SeenHull SeeHull(HardHull which, recon::ViewSceneRig rig);

}  // namespace elbowroom::accuracy
