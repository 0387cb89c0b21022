// Rods before a simulated rig, and their silhouettes.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "core/rig.h"
#include "core/soft_mask.h"
#include "recon/synthetic/solids.h"

namespace elbowroom::recon::testing {

struct Rod {
  Eigen::Vector3d middle_in_world = Eigen::Vector3d::Zero();
  Eigen::Vector3d direction_in_world = Eigen::Vector3d::UnitX();  // any length
  double diameter_mm = 10.0;
  double length_mm = 300.0;
};

// A full cylinder, cut flat.
[[nodiscard]] SyntheticObject RodObject(const Rod& rod);

// An arc of capsules whose axis is off the straight line by `bow_mm`, towards z (or x for an upright rod).
[[nodiscard]] SyntheticObject BowedRod(const Rod& rod, double bow_mm);

// A hand and forearm with its palm about the rod's end, for one that points along its negative direction.
[[nodiscard]] SyntheticObject HandAtTheEnd(const Rod& rod);

// Middles of 3 x 3 x 3 cells of the share of the workspace around its centre, and directions all different.
// `draw` 0: these; others: each moved within its cell and turned at random.
[[nodiscard]] std::vector<Rod> TwentySevenRods(const core::Rig& rig, double share, double diameter_mm,
                                               double length_mm, unsigned draw = 0);

enum class Silhouettes { kReady, kSegmented };

// A rig before which objects are put: gives what its cameras make of them, ready masks, or pictures with 2 %
// noise and pixels of mixed colour, segmented.
class RodStage {
 public:
  RodStage(const core::Rig& rig, Silhouettes silhouettes);
  ~RodStage();
  RodStage(const RodStage&) = delete;
  RodStage& operator=(const RodStage&) = delete;

  [[nodiscard]] std::vector<core::SoftMask> MasksOf(const std::vector<SyntheticObject>& objects);

 private:
  struct Inside;
  std::unique_ptr<Inside> inside_;
};

// Cameras 1200 mm around the place, evenly, looking at it from above and from the side in turn.
[[nodiscard]] core::Rig RingRig(int cameras);

// The rig with one camera turned about a direction.
[[nodiscard]] core::Rig WithTurnedCamera(const core::Rig& rig, std::size_t camera, double angle_deg,
                                         const Eigen::Vector3d& about_in_world);

}  // namespace elbowroom::recon::testing
