#include "review/penetration.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <vector>

#include "core/error.h"
#include "core/part_distance.h"
#include "core/units.h"
#include "recon/hull/hull_depth.h"
#include "review/escape_distance.h"
#include "review/inside_cells.h"

namespace elbowroom::review {
namespace {

using core::NearestOnPart;
using Eigen::Vector3d;

// From how many points the deepest is searched for, and how many points each direction's rays start with.
constexpr std::size_t kStarts = 3;
constexpr std::size_t kFirstWitnesses = 12;
// The best direction is turned by this angle to four sides, for as long as that helps, then by half of it,
// and so on.
constexpr double kFirstTurnRad = core::RadiansFromDegrees(16.0);
constexpr double kLastTurnRad = core::RadiansFromDegrees(2.0);
constexpr int kMostTurns = 16;
// The first step towards the deepest point, as a share of the part's size.
constexpr double kFirstWayStep = 0.25;
constexpr int kMostWaySteps = 200;
// Rounding of distances to the part, as a share of the coordinates' size.
constexpr double kWayRounding = 1e-12;

// A point of part and hull, with the sum of its depths in both.
struct Deep {
  double sum_mm = -1.0;
  Vector3d x_in_world = Vector3d::Zero();
  std::array<std::optional<Vector3d>, 2> ways_out;  // out of the hull, out of the part
};

class PenetrationSearch {
 public:
  PenetrationSearch(const recon::VisualHull& hull, const core::TriangleTree& part,
                    const core::RigidTransform& world_from_part, double tolerance_mm)
      : hull_(hull),
        part_(part),
        world_from_part_(world_from_part),
        part_from_world_(world_from_part.Inverse()),
        tolerance_mm_(tolerance_mm) {}

  Penetration Run(const core::PartContact& contact) {
    const std::vector<Vector3d> starts = PointsOf(contact);
    core::Require(!starts.empty(), "a contact has points");
    std::vector<Deep> deep;
    for (const Vector3d& start : starts) deep.push_back(DeepAt(start));
    std::ranges::sort(deep, std::greater(), &Deep::sum_mm);
    Deep deepest = deep.front();
    for (std::size_t i = 0; i < std::min(deep.size(), kStarts); ++i) {
      const Deep climbed = Climb(deep[i]);
      if (climbed.sum_mm > deepest.sum_mm) deepest = climbed;
    }
    result_.deepest_in_world = deepest.x_in_world;
    result_.lower_mm = std::max(deepest.sum_mm, 0.0);
    for (std::size_t i = 0; i < std::min(deep.size(), kFirstWitnesses); ++i)
      witnesses_.push_back(deep[i].x_in_world);
    for (const Vector3d& direction : FirstDirections(contact, deepest)) Try(direction);
    Turn();
    result_.lower_mm = std::min(result_.lower_mm, result_.upper_mm);
    return result_;
  }

 private:
  static std::vector<Vector3d> PointsOf(const core::PartContact& contact) {
    std::vector<Vector3d> points;
    for (const core::ContactPoint& point : contact.points) points.push_back(point.position_in_world_mm);
    if (contact.deepest) points.push_back(contact.deepest->position_in_world_mm);
    if (contact.recovery) points.push_back(contact.recovery->cp_obj_in_world_mm);
    if (contact.contained_in_world_mm) points.push_back(*contact.contained_in_world_mm);
    return points;
  }

  // The depths at the point itself if it is inside the closed part, else at the part's nearest point.
  Deep DeepAt(const Vector3d& near_in_world) {
    const Vector3d near = part_from_world_ * near_in_world;
    const NearestOnPart nearest = FindNearest(part_, {near});
    const bool is_inside = part_.is_closed() && IsInsideClosedMesh(part_, near);
    Deep deep;
    deep.x_in_world = is_inside ? near_in_world : world_from_part_ * nearest.position_in_part;
    ++result_.depths;
    const auto depth = recon::DepthAt(hull_, deep.x_in_world);
    if (!depth) return deep;
    deep.sum_mm = depth->depth_mm;
    AddWay(depth->nearest_in_world - deep.x_in_world, &deep.ways_out[0]);
    if (!is_inside) return deep;
    const double rounding_mm = kWayRounding * (near.lpNorm<1>() + near_in_world.lpNorm<1>());
    deep.sum_mm += std::max(nearest.distance_mm - rounding_mm, 0.0);
    AddWay(near_in_world - world_from_part_ * nearest.position_in_part, &deep.ways_out[1]);
    return deep;
  }

  static void AddWay(const Vector3d& way, std::optional<Vector3d>* direction) {
    if (way.norm() > 0.0) *direction = way.normalized();
  }

  // Steps along the axes while that gets deeper, then halves the step.
  Deep Climb(Deep from) {
    double step_mm = kFirstWayStep * part_.bounds().diagonal().norm();
    for (int i = 0; i < kMostWaySteps && step_mm > 0.25 * tolerance_mm_; ++i) {
      Deep best = from;
      for (int side = 0; side < 6; ++side) {
        const Vector3d step = (side % 2 == 0 ? step_mm : -step_mm) * Vector3d::Unit(side / 2);
        const Deep next = DeepAt(from.x_in_world + step);
        if (next.sum_mm > best.sum_mm) best = next;
      }
      if (best.sum_mm <= from.sum_mm) step_mm *= 0.5;
      from = best;
    }
    return from;
  }

  static std::vector<Vector3d> FirstDirections(const core::PartContact& contact, const Deep& deepest) {
    std::vector<Vector3d> directions;
    for (const std::optional<Vector3d>& way : deepest.ways_out) {
      if (way) directions.push_back(*way);
    }
    if (contact.recovery) {
      directions.push_back(contact.recovery->v_rec_in_world);
      if (contact.recovery->n_hull_in_world) directions.push_back(*contact.recovery->n_hull_in_world);
    }
    for (int i = 0; i < 27; ++i) {
      const Eigen::Vector3i direction(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
      if (!direction.isZero()) directions.push_back(direction.cast<double>().normalized());
    }
    return directions;
  }

  // True if the way in this direction is shorter than the best so far.
  bool Try(const Vector3d& direction) {
    ++result_.directions;
    const EscapeOptions options{tolerance_mm_, result_.upper_mm};
    const EscapeDistance escape =
        FindEscapeDistance(hull_, part_, world_from_part_, direction, &witnesses_, options);
    result_.queries += escape.queries;
    result_.rays += escape.rays;
    if (!(escape.upper_mm < result_.upper_mm)) return false;
    result_.upper_mm = escape.upper_mm;
    result_.direction_in_world = direction;
    result_.leaves_workspace = escape.leaves_workspace;
    return true;
  }

  void Turn() {
    double turn_rad = kFirstTurnRad;
    for (int i = 0; i < kMostTurns && turn_rad >= kLastTurnRad; ++i) {
      if (result_.upper_mm - result_.lower_mm <= tolerance_mm_) return;
      const Vector3d best = result_.direction_in_world;
      const Vector3d across = best.unitOrthogonal(), other = best.cross(across);
      bool is_better = false;
      for (const Vector3d& side : {across, other, Vector3d(-across), Vector3d(-other)})
        is_better |= Try((std::cos(turn_rad) * best + std::sin(turn_rad) * side).normalized());
      if (!is_better) turn_rad *= 0.5;
    }
  }

  const recon::VisualHull& hull_;
  const core::TriangleTree& part_;
  const core::RigidTransform& world_from_part_;
  const core::RigidTransform part_from_world_;
  double tolerance_mm_;
  std::vector<Vector3d> witnesses_;
  Penetration result_;
};

}  // namespace

Penetration FindPenetration(const recon::VisualHull& hull, const core::TriangleTree& part,
                            const core::RigidTransform& world_from_part, const core::PartContact& contact,
                            double tolerance_mm) {
  core::Require(contact.verdict == core::Verdict::kContact, "a part in contact");
  core::Require(tolerance_mm > 0.0, "a positive tolerance");
  return PenetrationSearch(hull, part, world_from_part, tolerance_mm).Run(contact);
}

}  // namespace elbowroom::review
