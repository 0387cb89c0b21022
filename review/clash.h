// Virtual parts against each other: which parts of a layout meet, and how far apart the others are.
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

// Surfaces that are no farther apart than this touch: parts that decimal numbers and rotations place face to
// face end up some 1e-13 mm apart. A required clearance counts as kept if no more than this is missing.
inline constexpr double kTouchMm = 1e-6;

struct PairClash {
  PairDemand demand;
  core::Verdict verdict = core::Verdict::kClear;
  // Between the surfaces, with a point of each, in world; 0 where they meet. Nothing: the bounds already show
  // that the pair is clear.
  std::optional<SurfaceGap> gap;
  double at_least_mm = 0.0;     // lower bound of the distance: the gap, or the distance of the bounds
  double uncertainty_mm = 0.0;  // of both parts together, as given
  double deviation_mm = 0.0;    // of both meshes together: the true distance is within this of the gap
  bool contained = false;       // a piece of one is inside the other, a closed one, without touching it
};

// How many pairs were asked about and how many skipped. pairs = unchanged + moved_together +
// settled_by_bounds + those asked of FCL.
struct ClashCount {
  std::int64_t pairs = 0;
  std::int64_t unchanged = 0;          // neither part moved since the last check
  std::int64_t moved_together = 0;     // both were shifted by the same, but for rounding
  std::int64_t settled_by_bounds = 0;  // pairs with a moved part that their bounds showed to be clear
  std::int64_t collision_calls = 0;    // of FCL: do two surfaces meet?
  std::int64_t distance_calls = 0;     // of FCL: how far apart are they?

  // Adds the counts of another check.
  ClashCount& operator+=(const ClashCount& other);
};

struct ClashReport {
  std::vector<PairClash> pairs;  // in the order of the demands
  ClashCount count;
};

// A pair is in `contact` where its surfaces are within kTouchMm or a piece of one part is inside the other,
// `near` below the required clearance, else `clear`. It is `undecided` where the uncertainty of both parts
// and the deviation of both meshes, subtracted from the distance or added to it, would change that; but
// meshes without uncertainty that meet are in contact, whatever their deviation. Distance and witness points
// are exact but for rounding. Held to brute force in long double by tests/review/clash_test.cc, and on real
// CAD by shared_clash_test.cc. Limits: an open part contains nothing; how deep surfaces overlap isn't asked
// (FCL's depth for meshes isn't that), so parts with an uncertainty that meet are `undecided`. Keeps FCL's
// models, one a mesh even if several parts share it, and the last answers. Thread: one.
class ClashChecker {
 public:
  // uncertainty_mm: one value a part, how far it may be from its CAD surface; empty: 0 for all. Throws:
  // core::PreconditionError for another number of values, a negative one, a pair that isn't of the layout's
  // parts, or one with a part without triangles. Parts that are in no pair cost nothing.
  ClashChecker(const core::Layout& layout, std::vector<PairDemand> pairs,
               std::vector<double> uncertainty_mm = {});

  // Judges every pair with the parts at these poses (one a part). A pair neither part of which moved since
  // the last check keeps its answer; so does one whose parts were both shifted, and by the same: its answer
  // moves with them. FCL is asked only about those of the others that their bounds don't show to be clear.
  // The result doesn't depend on the number of threads. Throws: core::Error{kCancelled}; the last answers
  // stay.
  [[nodiscard]] ClashReport Check(std::span<const core::RigidTransform> world_from_parts,
                                  const core::Progress& progress = {}, const std::stop_token& stop = {});

 private:
  struct Part {
    std::shared_ptr<const SurfaceModel> model;  // null: in no pair
    double uncertainty_mm = 0.0;
    core::RigidTransform world_from_part;
    Eigen::AlignedBox3d turned_bounds;    // with its rotation, before it is shifted
    Eigen::AlignedBox3d bounds_in_world;  // rounded outwards
  };

  enum class Motion { kNone, kShifted, kTurned };

  // Where the parts of a pair stood when it was last worked out.
  struct Asked {
    Eigen::Vector3d a_in_world_mm = Eigen::Vector3d::Zero();
    Eigen::Vector3d b_in_world_mm = Eigen::Vector3d::Zero();
  };

  // Moves those of `parts` whose pose differs, and says how.
  [[nodiscard]] std::vector<Motion> Place(std::span<const core::RigidTransform> world_from_parts,
                                          std::vector<Part>& parts) const;
  // Whether the pair keeps its answer of `asked`.
  [[nodiscard]] static bool MovedTogether(const Asked& asked, const Part& a, const Part& b);
  [[nodiscard]] std::vector<PairClash> Answers() const;
  [[nodiscard]] static PairClash Ask(const PairDemand& demand, const std::vector<Part>& parts,
                                     ClashCount& count);

  std::vector<PairDemand> demands_;
  std::vector<Part> parts_;
  std::vector<PairClash> last_;  // one a demand, as it was worked out
  std::vector<Asked> asked_;     // one a demand
  bool has_checked_ = false;
};

}  // namespace elbowroom::review
