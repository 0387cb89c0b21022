#include "review/pushed_part.h"

#include <algorithm>
#include <limits>
#include <optional>

#include "core/error.h"
#include "review/contacts.h"
#include "review/hull_march.h"

namespace elbowroom::review {
namespace {

using Eigen::Vector3d;

// Beyond the hull's end, so that the part is out and not at the end.
constexpr double kMarginMm = 0.5;
constexpr double kFarthestMm = 3000.0;
constexpr int kMostAdvances = 200;

struct WayOut {
  Vector3d v_rec_in_world = Vector3d::Zero();
  double d_rec_mm = 0.0;
};

// What brings every contact point out of the hull along a direction.
std::optional<double> NeededAlong(const recon::VisualHull& hull, const core::PartContact& contact,
                                  const Vector3d& direction) {
  double needed_mm = 0.0;
  for (const core::ContactPoint& point : contact.points) {
    const auto exit_mm = ExitAlong(hull, {point.position_in_world_mm, direction}, kFarthestMm);
    if (!exit_mm) return std::nullopt;
    needed_mm = std::max(needed_mm, *exit_mm);
  }
  return needed_mm;
}

std::optional<WayOut> FindWayOut(const core::PushRule& rule, const core::RigidTransform& world_from_part,
                                 const recon::VisualHull& hull, const core::PartContact& contact) {
  if (contact.points.empty()) return std::nullopt;
  if (!rule.v_rec) {
    if (!contact.recovery) return std::nullopt;
    return WayOut{contact.recovery->v_rec_in_world, contact.recovery->d_rec_mm};
  }
  std::optional<WayOut> best;
  for (const double side : {1.0, -1.0}) {
    const Vector3d direction = side * (world_from_part.rotation * rule.v_rec->normalized());
    const std::optional<double> needed_mm = NeededAlong(hull, contact, direction);
    if (needed_mm && (!best || *needed_mm < best->d_rec_mm)) best = WayOut{direction, *needed_mm};
  }
  return best;
}

double GapMm(const StandingPart& part, const Vector3d& moved, std::span<const StandingPart> others) {
  core::RigidTransform world_from_part = part.world_from_part;
  world_from_part.translation_mm += moved;
  double gap_mm = std::numeric_limits<double>::infinity();
  for (const StandingPart& other : others) {
    const SurfacePair pair(*part.surface, world_from_part, *other.surface, other.world_from_part);
    if (pair.BoundsGapMm() >= gap_mm) continue;
    gap_mm = std::min(gap_mm, pair.Measure().distance_mm);
  }
  return gap_mm;
}

// How far along a direction there is room: no point of the part moves farther at a time than the gap is wide.
double Advance(const StandingPart& part, const Vector3d& from, const WayOut& way, double wanted_mm,
               std::span<const StandingPart> others) {
  double gone_mm = 0.0, gap_mm = GapMm(part, from, others);
  for (int i = 0; i < kMostAdvances && gone_mm < wanted_mm; ++i) {
    const double step_mm = std::min(std::max(gap_mm - 2.0 * kPushGapMm, kPushGapMm), wanted_mm - gone_mm);
    const double next_gap_mm = GapMm(part, from + (gone_mm + step_mm) * way.v_rec_in_world, others);
    // A step into the last of the gap must lead away from what is there.
    if (next_gap_mm < kPushGapMm && next_gap_mm <= gap_mm) break;
    gone_mm += step_mm;
    gap_mm = next_gap_mm;
  }
  return gone_mm;
}

}  // namespace

PushState StepPush(const core::PushRule& rule, PushState state, const StandingPart& part,
                   std::span<const StandingPart> others, const recon::VisualHull& hull, double dt_s) {
  core::Require(part.surface != nullptr && dt_s > 0.0 && dt_s <= 1.0, "a part, and a step within (0, 1] s");
  state.wanted_mm = state.went_mm = 0.0;
  state.is_blocked = false;
  core::RigidTransform world_from_part = part.world_from_part;
  world_from_part.translation_mm += state.moved_in_world;
  const core::PartContact contact = FindContacts(hull, part.surface->tree(), world_from_part, 0);
  const std::optional<WayOut> way = FindWayOut(rule, world_from_part, hull, contact);
  if (!way) return state;
  state.wanted_mm = way->d_rec_mm + kMarginMm;
  const double may_mm = std::min(state.wanted_mm, rule.max_speed_mm_per_s * dt_s);
  state.went_mm = Advance(part, state.moved_in_world, *way, may_mm, others);
  state.is_blocked = state.went_mm < may_mm;
  state.moved_in_world += state.went_mm * way->v_rec_in_world;
  return state;
}

}  // namespace elbowroom::review
