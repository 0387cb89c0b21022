#include "review/contacts.h"

#include <fmt/format.h>
#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "recon/hull/visual_hull.h"
#include "review/contact_search.h"
#include "review/containment.h"
#include "review/point_spread.h"
#include "review/recovery.h"

namespace elbowroom::review {
namespace {

using Eigen::Vector3d;

ContactSearchRule SearchRule(const recon::VisualHull& hull, const core::TriangleTree& part,
                             const core::RigidTransform& world_from_part, const ContactOptions& options,
                             const Vector3d& rp_obj) {
  ContactSearchRule rule;
  rule.resolution_mm = ContactResolutionMm(hull, part, world_from_part, options);
  rule.point_spacing_mm = options.point_spacing_mm;
  rule.rp_obj = rp_obj;
  return rule;
}

// The hull inside a part whose surface it doesn't touch, after a search that took `*queries`.
std::optional<Vector3d> FindContained(const recon::VisualHull& hull,
                                      const core::RigidTransform& world_from_part,
                                      const core::TriangleTree& part, const ContactSearchRule& rule,
                                      InsideCells* inside, std::int64_t* queries) {
  if (*queries == 1) return std::nullopt;  // the ball around the whole part is outside the hull
  if (inside == nullptr) {
    InsideCells own(part);
    return FindContained(hull, world_from_part, part, rule, &own, queries);
  }
  return FindHullInside(hull, world_from_part, kContainmentCell * rule.resolution_mm, inside, queries);
}

// The deepest point; the first of several.
core::ContactPoint Deepest(const recon::VisualHull& hull, const std::vector<core::ContactPoint>& points) {
  core::ContactPoint deepest;
  core::CameraIndex likely = 0;
  for (const core::ContactPoint& point : points) {
    const bool is_first = &point == points.data();
    if (!is_first && !hull.MayBeDeeper(point.position_in_world_mm, deepest.depth_mm, &likely)) continue;
    const double depth_mm = hull.Probe(point.position_in_world_mm).radius_mm;
    if (!is_first && !(depth_mm > deepest.depth_mm)) continue;
    deepest = point;
    deepest.depth_mm = depth_mm;
  }
  return deepest;
}

}  // namespace

void ContactOptions::Validate() const {
  const auto require = [](bool holds, fmt::format_string<const double&> what, const double& value) {
    if (!holds)
      throw core::Error(core::ErrorKind::kRange, fmt::format("contacts: {}", fmt::format(what, value)));
  };
  require(resolution_mm >= 0.0 && std::isfinite(resolution_mm), "resolution must be positive, not {} mm",
          resolution_mm);
  require(point_spacing_mm > 0.0, "point spacing must be positive, not {} mm", point_spacing_mm);
  if (const auto broken = recovery.BrokenRule())
    throw core::Error(core::ErrorKind::kRange, fmt::format("contacts: recovery: {}", *broken));
  require(max_points > 0, "at least one contact point must be kept, not {}", max_points);
}

double ContactResolutionMm(const recon::VisualHull& hull, const core::TriangleTree& part,
                           const core::RigidTransform& world_from_part, const ContactOptions& options) {
  if (options.resolution_mm > 0.0) return options.resolution_mm;
  constexpr double kFallbackResolutionMm = 1.0;  // if no camera has the part in front of it
  const Vector3d center_in_world = world_from_part * part.nodes()[0].ball.center;
  return 0.5 * PixelFootprintMm(hull.rig(), center_in_world).value_or(2.0 * kFallbackResolutionMm);
}

std::optional<double> PixelFootprintMm(const core::Rig& rig, const Vector3d& x_in_world) {
  std::optional<double> smallest_mm;
  for (const core::CameraModel& camera : rig.cameras) {
    const Vector3d x_in_cam = camera.cam_from_world() * x_in_world;
    if (!(x_in_cam.z() > 0.0)) continue;
    const double footprint_mm = x_in_cam.z() / camera.PixelStretch(0.0);
    if (!smallest_mm || footprint_mm < *smallest_mm) smallest_mm = footprint_mm;
  }
  return smallest_mm;
}

core::PartContact FindContacts(const recon::VisualHull& hull, const core::TriangleTree& part,
                               const core::RigidTransform& world_from_part, core::PartIndex part_index,
                               const ContactOptions& options, InsideCells* inside, ReviewScratch* scratch) {
  if (scratch == nullptr) {
    ReviewScratch own;
    return FindContacts(hull, part, world_from_part, part_index, options, inside, &own);
  }
  options.Validate();
  core::PartContact contact;
  contact.part = part_index;
  contact.count.triangles = static_cast<std::int64_t>(part.mesh().triangles.size());
  contact.count.skipped = contact.count.triangles;
  if (part.nodes().empty() || hull.IsEmpty()) return contact;

  const RecoveryWay way = WayOf(options.recovery, part, world_from_part);
  const ContactSearchRule rule = SearchRule(hull, part, world_from_part, options, way.rp_obj);
  contact.resolution_mm = rule.resolution_mm;
  const ContactStretches* stretches = scratch->stretches.get();
  if (stretches != nullptr && !stretches->AreOf(part, rule.point_spacing_mm)) stretches = nullptr;
  FoundContacts found = SearchContacts(hull, part, world_from_part, rule, &scratch->search, stretches);
  contact.count.queries = found.count.queries;
  contact.count.skipped = found.count.skipped;
  scratch->search.points = std::move(found.points);

  const std::vector<core::ContactPoint>& points = scratch->search.points;
  if (points.empty()) {
    contact.contained_in_world_mm =
        FindContained(hull, world_from_part, part, rule, inside, &contact.count.queries);
    if (!contact.contained_in_world_mm) return contact;
    contact.verdict = core::Verdict::kContact;
    contact.recovery_status = core::RecoveryStatus::kHullInsidePart;
    return contact;
  }
  contact.verdict = core::Verdict::kContact;
  contact.contact_point_count = static_cast<std::int64_t>(points.size());
  for (const core::ContactPoint& point : points) contact.contact_area_mm2 += point.area_mm2;
  contact.count.queries += contact.contact_point_count;
  tbb::parallel_invoke(
      [&] {
        RecoveryAnswer answer = Recover(hull, found.farthest, way, &scratch->crossings);
        contact.recovery_status = answer.status;
        contact.recovery = std::move(answer.recovery);
        contact.deepest = Deepest(hull, points);
      },
      [&] {
        contact.points = SpreadEvenly(points, static_cast<std::size_t>(options.max_points), &scratch->spread);
        for (core::ContactPoint& point : contact.points)
          point.depth_mm = hull.Probe(point.position_in_world_mm).radius_mm;
      });
  return contact;
}

PartTouch FindTouch(const recon::VisualHull& hull, const core::TriangleTree& part,
                    const core::RigidTransform& world_from_part, const ContactOptions& options,
                    InsideCells* inside) {
  if (part.nodes().empty() || hull.IsEmpty()) return {};
  ContactSearchRule rule = SearchRule(hull, part, world_from_part, options, Vector3d::Zero());
  rule.ends_with_first = true;
  ContactSearchScratch scratch;
  const FoundContacts found = SearchContacts(hull, part, world_from_part, rule, &scratch);
  PartTouch touch;
  touch.queries = found.count.queries;
  if (!found.points.empty()) {
    touch.surface_in_world_mm = found.points.front().position_in_world_mm;
    touch.touches = true;
  } else {
    touch.touches = FindContained(hull, world_from_part, part, rule, inside, &touch.queries).has_value();
  }
  return touch;
}

std::optional<double> FindDeeper(const recon::VisualHull& hull, const core::TriangleTree& part,
                                 const core::RigidTransform& world_from_part, const ContactOptions& options,
                                 double least_mm, std::int64_t* queries) {
  if (part.nodes().empty() || hull.IsEmpty()) return std::nullopt;
  ContactSearchRule rule = SearchRule(hull, part, world_from_part, options, Vector3d::Zero());
  rule.deeper_than_mm = least_mm;
  ContactSearchScratch scratch;
  const FoundContacts found = SearchContacts(hull, part, world_from_part, rule, &scratch);
  *queries += found.count.queries;
  if (found.points.empty()) return std::nullopt;
  return std::ranges::max(found.points, {}, &core::ContactPoint::depth_mm).depth_mm;
}

}  // namespace elbowroom::review
