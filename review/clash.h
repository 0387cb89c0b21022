// Virtual against virtual: which parts of a layout meet, how far apart the others are.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <vector>

#include "core/contact.h"
#include "core/ids.h"
#include "core/layout.h"
#include "core/progress.h"
#include "core/rigid_transform.h"
#include "review/clash_pairs.h"
#include "review/surface_model.h"

namespace elbowroom::review {

// Surfaces this near touch: parts placed face to face by decimal numbers and rotations end up some 1e-13 mm
// apart. A required clearance counts as kept when no more than this is missing.
inline constexpr double kTouchMm = 1e-6;

struct PairClash {
  PairDemand demand;
  core::Verdict verdict = core::Verdict::kClear;
  // Between the surfaces, with a point of each, in world; 0 where they meet. Nothing: the bounds already say
  // that the pair is clear.
  std::optional<SurfaceGap> gap;
  double at_least_mm = 0.0;     // the distance is no less: the gap, or what lies between the bounds
  double uncertainty_mm = 0.0;  // of both parts together, as given
  double deviation_mm = 0.0;    // of both meshes together: the true distance is the gap, less or more this
  bool contained = false;       // a piece of one is inside the other, a closed one, without touching it
};

// What was asked and what was spared. pairs = unchanged + settled_by_bounds + those asked of FCL.
struct ClashCount {
  std::int64_t pairs = 0;
  std::int64_t unchanged = 0;          // neither part moved since the last check
  std::int64_t settled_by_bounds = 0;  // of those that changed
  std::int64_t collision_calls = 0;    // of FCL: do two surfaces meet?
  std::int64_t distance_calls = 0;     // of FCL: how far apart are they?
};

struct ClashReport {
  std::vector<PairClash> pairs;  // in the order of the demands
  ClashCount count;
};

// `contact` where surfaces are within kTouchMm or a piece of one part is inside the other, `near` below the
// required clearance, else `clear`; `undecided` where the distance less and plus the uncertainty of both
// parts and the deviation of both meshes would be judged differently; meshes that meet are in contact however
// well they stand for their surfaces. Distance and witness points are exact but for rounding. Held to brute
// force in long double by tests/review/clash_test.cc, and on real CAD by shared_clash_test.cc.
// Limits: an open part contains nothing; how deep surfaces that meet overlap isn't asked (FCL's figure for
// meshes isn't that depth), so parts with an uncertainty that merely meet are `undecided`.
// Keeps FCL's models, one a mesh however many parts share it, and the last answers. Thread: one.
class ClashChecker {
 public:
  // uncertainty_mm: how far each part may be from its CAD surface; empty: 0 for all. The pairs are
  // the layout's. Throws: core::PreconditionError for another number of them or a part without triangles.
  ClashChecker(const core::Layout& layout, std::vector<PairDemand> pairs,
               std::vector<double> uncertainty_mm = {});

  // Every pair with the parts at these poses, one a part. Asks only about pairs of which a part moved since
  // the last check, and FCL only about those whose bounds are nearer than the required clearance. The result
  // doesn't depend on the number of threads. Throws: core::Error{kCancelled}; the last answers stay.
  [[nodiscard]] ClashReport Check(std::span<const core::RigidTransform> world_from_parts,
                                  const core::Progress& progress = {}, const std::stop_token& stop = {});

 private:
  struct Part {
    std::shared_ptr<const SurfaceModel> model;
    double uncertainty_mm = 0.0;
    core::RigidTransform world_from_part;
    Eigen::AlignedBox3d bounds_in_world;  // rounded outwards
  };

  // Moves those of `parts` whose pose differs; which did.
  [[nodiscard]] std::vector<bool> Place(std::span<const core::RigidTransform> world_from_parts,
                                        std::vector<Part>& parts) const;
  [[nodiscard]] static PairClash Ask(const PairDemand& demand, const std::vector<Part>& parts,
                                     ClashCount& count);

  std::vector<PairDemand> demands_;
  std::vector<Part> parts_;
  std::vector<PairClash> last_;  // one a demand
  bool has_checked_ = false;
};

}  // namespace elbowroom::review
