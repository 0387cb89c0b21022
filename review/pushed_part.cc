#include "review/pushed_part.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <variant>

#include "core/error.h"
#include "review/recovery.h"

namespace elbowroom::review {
namespace {

using core::RecoveryKind;
using core::RigidTransform;
using Eigen::Vector3d;

// A part is moved this far beyond the hull's end, so that it doesn't stay on the surface.
constexpr double kPushMarginMm = 0.5;
constexpr int kMostAdvances = 200;

// A motion that leads out of the hull, in world: along a line, or about an axis.
struct WayOut {
  bool turns = false;
  Vector3d axis = Vector3d::UnitX();  // unit
  Vector3d at_mm = Vector3d::Zero();  // on the axis it turns about
  double arm_mm = 1.0;                // distance of the part's farthest point from that axis
  double wanted_mm = 0.0;             // the way of the part's fastest point

  [[nodiscard]] RigidTransform By(double mm) const {
    if (!turns) return {Eigen::Matrix3d::Identity(), mm * axis};
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(mm / arm_mm, axis).toRotationMatrix();
    return {turn, at_mm - turn * at_mm};
  }
};

double DistanceToAxis(const RecoveryWay& way, const Vector3d& x_in_world) {
  return way.axis.cross(x_in_world - way.at_mm).norm();
}

double LongestArm(const RecoveryWay& way, const SurfaceModel& surface,
                  const RigidTransform& world_from_part) {
  double longest_mm = 0.0;
  for (const Vector3d& vertex : surface.tree().mesh().vertices_mm)
    longest_mm = std::max(longest_mm, DistanceToAxis(way, world_from_part * vertex));
  return longest_mm;
}

// The motion that brings every contact point out of the hull in one sense. Nothing if one has no way out.
std::optional<WayOut> InOneSense(const recon::VisualHull& hull, const core::PartContact& contact,
                                 const RecoveryWay& way, const StandingPart& part) {
  const double sense = way.sense < 0 ? -1.0 : 1.0;
  WayOut out{.turns = way.kind == RecoveryKind::kHinge, .axis = sense * way.axis, .at_mm = way.at_mm};
  if (out.turns) out.arm_mm = LongestArm(way, *part.surface, part.world_from_part);
  for (const core::ContactPoint& point : contact.points) {
    const RecoveryAnswer answer = Recover(hull, point.position_in_world_mm, way);
    if (!answer.recovery || answer.status == core::RecoveryStatus::kNoExit) return std::nullopt;
    const double way_mm = answer.recovery->d_rec_mm + kPushMarginMm;
    const double share = out.turns ? out.arm_mm / DistanceToAxis(way, point.position_in_world_mm) : 1.0;
    out.wanted_mm = std::max(out.wanted_mm, share * way_mm);
  }
  return out;
}

std::optional<WayOut> FindWayOut(const core::RecoveryRule& rule, const recon::VisualHull& hull,
                                 const core::PartContact& contact, const StandingPart& part) {
  if (contact.points.empty()) return std::nullopt;
  if (rule.kind == RecoveryKind::kReference) {
    if (!contact.recovery || contact.recovery_status == core::RecoveryStatus::kNoExit) return std::nullopt;
    return WayOut{.axis = contact.recovery->v_rec_in_world,
                  .wanted_mm = contact.recovery->d_rec_mm + kPushMarginMm};
  }
  RecoveryWay way = WayOf(rule, part.surface->tree(), part.world_from_part);
  if (rule.kind == RecoveryKind::kDirection) return InOneSense(hull, contact, way, part);
  std::optional<WayOut> best;
  for (const int sense : {1, -1}) {
    way.sense = sense;
    const std::optional<WayOut> found = InOneSense(hull, contact, way, part);
    if (found && (!best || found->wanted_mm < best->wanted_mm)) best = found;
  }
  return best;
}

double GapMm(const StandingPart& part, const RigidTransform& moved, std::span<const StandingPart> others) {
  const RigidTransform world_from_part = moved * part.world_from_part;
  double gap_mm = std::numeric_limits<double>::infinity();
  for (const StandingPart& other : others) {
    const SurfacePair pair(*part.surface, world_from_part, *other.surface, other.world_from_part);
    if (pair.BoundsGapMm() >= gap_mm) continue;
    gap_mm = std::min(gap_mm, pair.Measure().distance_mm);
  }
  return gap_mm;
}

// How far the part can move: in steps that take no point farther than the gap is wide, so that it can't pass
// through another part.
double Advance(const StandingPart& part, const WayOut& way, double wanted_mm,
               std::span<const StandingPart> others) {
  double gone_mm = 0.0, gap_mm = GapMm(part, {}, others);
  for (int i = 0; i < kMostAdvances && gone_mm < wanted_mm; ++i) {
    const double step_mm = std::min(std::max(gap_mm - 2.0 * kPushGapMm, kPushGapMm), wanted_mm - gone_mm);
    const double next_gap_mm = GapMm(part, way.By(gone_mm + step_mm), others);
    // A step that ends with less than the smallest gap must have widened it.
    if (next_gap_mm < kPushGapMm && next_gap_mm <= gap_mm) break;
    gone_mm += step_mm;
    gap_mm = next_gap_mm;
  }
  return gone_mm;
}

}  // namespace

PushState StepPush(const core::Part& part, const core::PartContact& contact, PushState state,
                   const StandingPart& rest, std::span<const StandingPart> others,
                   const recon::VisualHull& hull, double dt_s) {
  core::Require(rest.surface != nullptr && dt_s > 0.0 && dt_s <= 1.0, "a part, and a step within (0, 1] s");
  state.wanted_mm = state.went_mm = 0.0;
  state.is_blocked = false;
  const StandingPart standing{rest.surface, rest.world_from_part * state.rest_from_part};
  const std::optional<WayOut> way = FindWayOut(part.recovery, hull, contact, standing);
  if (!way) return state;
  state.wanted_mm = way->wanted_mm;
  const double speed_mm_per_s = std::get<core::PushRule>(part.gives_way).max_speed_mm_per_s;
  const double may_mm = std::min(state.wanted_mm, speed_mm_per_s * dt_s);
  state.went_mm = Advance(standing, *way, may_mm, others);
  state.is_blocked = state.went_mm < may_mm;
  if (state.went_mm > 0.0) {
    state.rest_from_part = rest.world_from_part.Inverse() * way->By(state.went_mm) * standing.world_from_part;
    state.rest_from_part.rotation = Eigen::Quaterniond(state.rest_from_part.rotation).normalized();
  }
  return state;
}

}  // namespace elbowroom::review
