#include "review/escape_distance.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "recon/hull/ray_crossings.h"
#include "recon/hull/visual_hull.h"
#include "review/hull_part_intersection.h"

namespace elbowroom::review {
namespace {

using Eigen::Vector3d;
using recon::HullInterval;

// Rounding of crossings, by which lower bounds are lowered.
constexpr double kEscapeRoundingMm = 1e-6;
// The first place tried is this share of the tolerance past all known contact. There the part is tested in
// pieces down to kSmallestPiece of that step.
constexpr double kFirstEscapeStep = 0.5;
constexpr double kSmallestPiece = 0.25;
// Gaps in the known contact that are narrower than this share of the tolerance aren't tried.
constexpr double kNarrowGap = 1.0 / 16.0;

// One part on its way in one direction.
class Way {
 public:
  Way(const recon::VisualHull& hull, const core::TriangleTree& part,
      const core::RigidTransform& world_from_part, const Vector3d& direction, const EscapeOptions& options)
      : hull_(hull),
        part_(part),
        world_from_part_(world_from_part),
        direction_(direction),
        options_(options),
        step_mm_(kFirstEscapeStep * options.tolerance_mm) {}

  // Adds the intervals in which this point, moved along, is in the hull. The part is in contact throughout
  // them.
  void Follow(const Vector3d& x_in_world) {
    ++result_.rays;
    const auto intervals = recon::IntervalsInHull(hull_, {x_in_world, direction_});
    in_contact_.insert(in_contact_.end(), intervals.begin(), intervals.end());
    std::ranges::sort(in_contact_, {}, &HullInterval::from_mm);
    known_mm_ = 0.0;
    for (const HullInterval& interval : in_contact_) {
      if (interval.from_mm > known_mm_) break;
      if (interval.to_mm <= known_mm_) continue;
      known_mm_ = interval.to_mm;
      result_.leaves_workspace = !interval.exit.camera || interval.exit.is_outline;
    }
  }

  [[nodiscard]] EscapeDistance Run(std::vector<Vector3d>* witnesses) {
    double at_mm = known_mm_ > 0.0 ? known_mm_ + step_mm_ : 0.0;
    while (known_mm_ < options_.give_up_mm) {
      const double before_mm = known_mm_;
      if (IsFree(at_mm, witnesses)) {
        result_.upper_mm = at_mm;
        break;
      }
      at_mm = NextPlace(at_mm, before_mm);
    }
    if (std::isfinite(result_.upper_mm)) StepBack(witnesses);
    result_.lower_mm = std::clamp(known_mm_ - kEscapeRoundingMm, 0.0, result_.upper_mm);
    return result_;
  }

 private:
  // True if the part is certainly free at this place. Otherwise a common point, if there is one, becomes a
  // witness.
  [[nodiscard]] bool IsFree(double at_mm, std::vector<Vector3d>* witnesses) {
    const core::RigidTransform moved{world_from_part_.rotation,
                                     world_from_part_.translation_mm + at_mm * direction_};
    const HullPartIntersection meeting = FindHullPartIntersection(
        hull_, part_, moved, kSmallestPiece * options_.tolerance_mm * kFirstEscapeStep, &result_.queries);
    if (meeting.answer == HullPartIntersection::Answer::kApart) return true;
    taken_mm_ = std::max(taken_mm_, at_mm);
    if (meeting.answer == HullPartIntersection::Answer::kIntersects) {
      witnesses->push_back(meeting.common_in_world - at_mm * direction_);
      Follow(witnesses->back());
    }
    return false;
  }

  // Bisects between the last place that isn't free and the first that is: long steps may have left them far
  // apart.
  void StepBack(std::vector<Vector3d>* witnesses) {
    // If the free place is in a gap, places beyond it were tried before: they don't count.
    double taken_mm = taken_mm_ < result_.upper_mm ? std::max(taken_mm_, known_mm_) : known_mm_;
    while (result_.upper_mm - taken_mm > options_.tolerance_mm) {
      const double middle_mm = 0.5 * (taken_mm + result_.upper_mm);
      (IsFree(middle_mm, witnesses) ? result_.upper_mm : taken_mm) = middle_mm;
    }
  }

  // The place to try after one that isn't free: just past the known contact if that has grown; else the
  // middle of its first gap, if that is wide enough and wasn't tried; else farther on, by steps that double.
  [[nodiscard]] double NextPlace(double at_mm, double before_mm) {
    if (known_mm_ > before_mm) {
      step_mm_ = kFirstEscapeStep * options_.tolerance_mm;
      return known_mm_ + step_mm_;
    }
    const auto next = std::ranges::upper_bound(in_contact_, known_mm_, {}, &HullInterval::from_mm);
    const double gap_end_mm = next == in_contact_.end() ? at_mm : std::min(next->from_mm, at_mm);
    const double middle_mm = 0.5 * (known_mm_ + gap_end_mm);
    if (middle_mm < at_mm && middle_mm != tried_mm_ &&
        gap_end_mm - known_mm_ > kNarrowGap * options_.tolerance_mm) {
      tried_mm_ = middle_mm;
      farthest_mm_ = std::max(farthest_mm_, at_mm);
      return middle_mm;
    }
    farthest_mm_ = std::max(farthest_mm_, at_mm) + step_mm_;
    step_mm_ *= 2.0;
    return farthest_mm_;
  }

  const recon::VisualHull& hull_;
  const core::TriangleTree& part_;
  const core::RigidTransform& world_from_part_;
  const Vector3d& direction_;
  const EscapeOptions& options_;
  double step_mm_;
  double known_mm_ = 0.0;  // from 0 up to here some known point of the part is in the hull
  double tried_mm_ = -1.0;
  double taken_mm_ = 0.0;  // the farthest place found not to be free
  double farthest_mm_ = 0.0;
  std::vector<HullInterval> in_contact_;
  EscapeDistance result_;
};

}  // namespace

void EscapeOptions::Validate() const {
  const auto require = [](bool holds, const std::string& what) {
    if (!holds) throw core::Error(core::ErrorKind::kRange, "escape distance: " + what);
  };
  require(tolerance_mm > 0.0 && std::isfinite(tolerance_mm),
          fmt::format("tolerance must be positive, not {} mm", tolerance_mm));
  require(give_up_mm >= 0.0, fmt::format("the longest way must not be negative, not {} mm", give_up_mm));
}

EscapeDistance FindEscapeDistance(const recon::VisualHull& hull, const core::TriangleTree& part,
                                  const core::RigidTransform& world_from_part,
                                  const Vector3d& direction_in_world, std::vector<Vector3d>* witnesses,
                                  const EscapeOptions& options) {
  options.Validate();
  constexpr double kUnitSlack = 1e-9;
  core::Require(std::abs(direction_in_world.norm() - 1.0) <= kUnitSlack, "a direction is unit");
  if (part.nodes().empty() || hull.IsEmpty()) return {.upper_mm = 0.0};
  Way way(hull, part, world_from_part, direction_in_world, options);
  for (const Vector3d& witness : *witnesses) way.Follow(witness);
  return way.Run(witnesses);
}

}  // namespace elbowroom::review
