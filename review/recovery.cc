#include "review/recovery.h"

#include <Eigen/Geometry>

#include "core/error.h"
#include "recon/hull/arc_crossings.h"
#include "recon/hull/crossing_scratch.h"
#include "recon/hull/ray_crossings.h"
#include "recon/hull/visual_hull.h"

namespace elbowroom::review {
namespace {

using core::Recovery;
using core::RecoveryKind;
using core::RecoveryStatus;
using Eigen::Vector3d;

// Shorter ways have no direction.
constexpr double kNoLengthMm = 1e-9;
// Rounding of crossings and labels. A way that is no longer starts on the surface.
constexpr double kOnSurfaceMm = 1e-6;

// The end of a way in one sense.
struct Exit {
  double d_rec_mm = 0.0;
  Vector3d cp_hull;
  Vector3d v_rec;
  bool is_seen = true;  // a silhouette ends the hull there, not the end of what can be seen
  std::optional<double> angle_rad = std::nullopt;
};

bool IsSeen(const recon::HullBoundary& boundary) { return boundary.camera && !boundary.is_outline; }

// The end of the stretch of hull in which a ray starts, by the ray's crossings with the contours.
Exit ExactExit(const recon::VisualHull& hull, const Vector3d& x, const Vector3d& direction,
               recon::CrossingScratch* scratch) {
  Exit exit{0.0, x, direction};
  for (const recon::HullInterval& interval : recon::IntervalsInHull(hull, {x, direction}, {}, scratch)) {
    if (interval.from_mm > exit.d_rec_mm + kOnSurfaceMm) break;
    exit.d_rec_mm = interval.to_mm;
    exit.is_seen = IsSeen(interval.exit);
  }
  exit.cp_hull = x + exit.d_rec_mm * direction;
  return exit;
}

// The first hull point on the way from RP_obj to CP_obj. RP_obj isn't in the hull.
Exit ExitFromReference(const recon::VisualHull& hull, const Vector3d& cp_obj, const Vector3d& rp_obj,
                       const Vector3d& v_rec, double distance_mm, recon::CrossingScratch* scratch) {
  const auto intervals = recon::IntervalsInHull(hull, {rp_obj, -v_rec}, {0.0, distance_mm}, scratch);
  // CP_obj itself is in the hull, so the ray has entered it by then, but for rounding on its surface.
  if (intervals.empty()) return {0.0, cp_obj, v_rec};
  const recon::HullInterval& first = intervals.front();
  const bool starts_on_surface = first.from_mm == 0.0;
  return {distance_mm - first.from_mm, rp_obj - first.from_mm * v_rec, v_rec,
          starts_on_surface || IsSeen(first.entry)};
}

// Nothing if the whole circle is inside. `quarter`: where a quarter turn in this sense leads.
std::optional<Exit> ExitAround(const recon::VisualHull& hull, const Vector3d& center, const Vector3d& arm,
                               const Vector3d& quarter, double sense, recon::CrossingScratch* scratch) {
  const recon::Arc arc{center, arm, sense * quarter};
  const auto found = recon::FirstOutside(hull, arc, scratch);
  if (!found) return std::nullopt;
  return Exit{found->angle_rad * arm.norm(), arc.At(found->angle_rad), sense * quarter.normalized(),
              found->angle_rad == 0.0 || IsSeen(found->boundary), sense * found->angle_rad};
}

// A way that a silhouette ends is better than one that only the cameras' sight ends; of two alike, the
// shorter.
std::optional<Exit> Better(const std::optional<Exit>& a, const std::optional<Exit>& b) {
  if (!a || !b) return a ? a : b;
  if (a->is_seen != b->is_seen) return a->is_seen ? a : b;
  return b->d_rec_mm < a->d_rec_mm ? b : a;
}

RecoveryAnswer AnswerFor(const recon::VisualHull& hull, const Vector3d& cp_obj, const Exit& exit,
                         RecoveryStatus status = RecoveryStatus::kFound) {
  Recovery recovery{cp_obj, exit.cp_hull, exit.v_rec, exit.d_rec_mm, {}, exit.angle_rad};
  if (!exit.is_seen) return {RecoveryStatus::kNoExit, recovery};
  recovery.n_hull_in_world = hull.EdgeAt(exit.cp_hull).normal_in_world;
  const bool is_on_surface = status == RecoveryStatus::kFound && exit.d_rec_mm <= kOnSurfaceMm;
  return {is_on_surface ? RecoveryStatus::kOnSurface : status, recovery};
}

RecoveryAnswer TowardsReference(const recon::VisualHull& hull, const Vector3d& cp_obj, const Vector3d& rp_obj,
                                recon::CrossingScratch* scratch) {
  const double distance_mm = (rp_obj - cp_obj).norm();
  if (!(distance_mm > kNoLengthMm)) return {RecoveryStatus::kNoDirection, {}};
  const Vector3d v_rec = (rp_obj - cp_obj) / distance_mm;
  if (hull.Contains(rp_obj))
    return AnswerFor(hull, cp_obj, ExactExit(hull, cp_obj, v_rec, scratch),
                     RecoveryStatus::kReferenceInsideHull);
  return AnswerFor(hull, cp_obj, ExitFromReference(hull, cp_obj, rp_obj, v_rec, distance_mm, scratch));
}

RecoveryAnswer AlongSlider(const recon::VisualHull& hull, const Vector3d& cp_obj, const RecoveryWay& way,
                           recon::CrossingScratch* scratch) {
  std::optional<Exit> best;
  for (const int sense : {1, -1})
    if (way.sense != -sense) best = Better(best, ExactExit(hull, cp_obj, sense * way.axis, scratch));
  return AnswerFor(hull, cp_obj, *best);
}

RecoveryAnswer AboutHinge(const recon::VisualHull& hull, const Vector3d& cp_obj, const RecoveryWay& way,
                          recon::CrossingScratch* scratch) {
  const Vector3d center = way.at_mm + way.axis.dot(cp_obj - way.at_mm) * way.axis;
  const Vector3d arm = cp_obj - center, quarter = way.axis.cross(arm);
  if (!(arm.norm() > kNoLengthMm)) return {RecoveryStatus::kNoDirection, {}};
  std::optional<Exit> best;
  for (const int sense : {1, -1})
    if (way.sense != -sense) best = Better(best, ExitAround(hull, center, arm, quarter, sense, scratch));
  if (!best) return {RecoveryStatus::kNoExit, {}};
  return AnswerFor(hull, cp_obj, *best);
}

}  // namespace

RecoveryWay WayOf(const core::RecoveryRule& rule, const core::TriangleTree& part,
                  const core::RigidTransform& world_from_part) {
  core::Require(!rule.BrokenRule(), "a recovery that can be used");
  RecoveryWay way;
  way.kind = rule.kind;
  // The root ball stands at the centre of the bounds.
  way.rp_obj = world_from_part * rule.reference_in_part_mm.value_or(part.nodes()[0].ball.center);
  if (rule.axis_in_part) way.axis = world_from_part.rotation * rule.axis_in_part->stableNormalized();
  if (rule.at_in_part_mm) way.at_mm = world_from_part * *rule.at_in_part_mm;
  return way;
}

RecoveryAnswer Recover(const recon::VisualHull& hull, const Vector3d& cp_obj, const RecoveryWay& way) {
  recon::CrossingScratch own;
  return Recover(hull, cp_obj, way, &own);
}

RecoveryAnswer Recover(const recon::VisualHull& hull, const Vector3d& cp_obj, const RecoveryWay& way,
                       recon::CrossingScratch* scratch) {
  switch (way.kind) {
    case RecoveryKind::kReference:
      return TowardsReference(hull, cp_obj, way.rp_obj, scratch);
    case RecoveryKind::kDirection:
      return AnswerFor(hull, cp_obj, ExactExit(hull, cp_obj, way.axis, scratch));
    case RecoveryKind::kSlider:
      return AlongSlider(hull, cp_obj, way, scratch);
    case RecoveryKind::kHinge:
      return AboutHinge(hull, cp_obj, way, scratch);
  }
  core::Require(false, "a kind of recovery");
  return {};
}

}  // namespace elbowroom::review
