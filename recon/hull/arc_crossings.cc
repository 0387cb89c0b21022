#include "recon/hull/arc_crossings.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include "core/error.h"
#include "recon/contours/silhouette.h"
#include "recon/hull/crossing_scratch.h"
#include "recon/hull/visual_hull.h"

namespace elbowroom::recon {
namespace {

using Eigen::Vector3d;

constexpr double kTurnRad = 2.0 * std::numbers::pi;
constexpr double kSkew = 1e-9;  // a share of the radius: so far off, an arc still counts as a circle
// A meeting this far beside an edge, as a share of all lengths, still counts. One too many does no harm,
// since the label between two meetings is asked.
constexpr double kBeside = 1e-9;
// Two meetings so close are one: nothing can be asked in between.
constexpr double kSameRad = 1e-13;

// The angles at which normal . x(angle) = offset, in [0, 2 pi). With a = along_start and b = along_quarter, a
// cos(angle) + b sin(angle) = reach cos(angle - middle), so these are middle +- acos(rise / reach).
template <typename Visit>
void VisitMeetings(const Arc& arc, const Vector3d& normal, double offset, const Visit& visit) {
  const double rise = offset - normal.dot(arc.center_in_world);
  const double along_start = normal.dot(arc.start_in_world), along_quarter = normal.dot(arc.quarter_in_world);
  const double reach = std::hypot(along_start, along_quarter);
  if (!(std::abs(rise) <= reach) || reach == 0.0) return;
  const double middle_rad = std::atan2(along_quarter, along_start), half_rad = std::acos(rise / reach);
  for (const double angle_rad : {middle_rad - half_rad, middle_rad + half_rad}) {
    const double turned = std::fmod(angle_rad, kTurnRad);
    visit(turned < 0.0 ? turned + kTurnRad : turned);
  }
}

// Adds where the circle meets the sectors that the edges span: the plane between the rays through an edge's
// ends.
void AddMeetings(const Arc& in_cam, const UndistortedPlane& plane, const Contour& contour,
                 const HullBoundary& of_camera, std::vector<ArcMeeting>* meetings) {
  const auto direction = [&](std::uint32_t vertex) {
    const Eigen::Vector2d& v = contour.vertices[vertex];
    return Vector3d(v.x(), v.y(), plane.focal_px());
  };
  HullBoundary boundary = of_camera;
  for (std::uint32_t e = 0; e < contour.edges.size(); ++e) {
    const Vector3d a = direction(contour.edges[e].from), b = direction(contour.edges[e].to);
    const Vector3d normal = a.cross(b);
    boundary.edge = e;
    VisitMeetings(in_cam, normal, 0.0, [&](double angle_rad) {
      const Vector3d x = in_cam.At(angle_rad);
      const double slack = kBeside * normal.norm() * x.norm();
      if (a.cross(x).dot(normal) < -slack * a.norm() || x.cross(b).dot(normal) < -slack * b.norm()) return;
      meetings->push_back({angle_rad, boundary});
    });
  }
}

// In order, in the scratch's memory.
std::span<const ArcMeeting> MeetingsOf(const VisualHull& hull, const Arc& arc, CrossingScratch* scratch) {
  std::vector<ArcMeeting>& meetings = scratch->meetings;
  meetings.clear();
  for (std::size_t i = 0; i < hull.silhouettes().size(); ++i) {
    const core::RigidTransform& cam_from_world = hull.rig().cameras[i].cam_from_world();
    const Arc in_cam{cam_from_world * arc.center_in_world, cam_from_world.rotation * arc.start_in_world,
                     cam_from_world.rotation * arc.quarter_in_world};
    const Silhouette& silhouette = *hull.silhouettes()[i];
    AddMeetings(in_cam, silhouette.plane(), silhouette.labels().contour(), {i, 0, false}, &meetings);
    if (ExteriorIsObject(hull.rig()))
      AddMeetings(in_cam, silhouette.plane(), silhouette.plane().outline().contour(), {i, 0, true},
                  &meetings);
  }
  const Eigen::AlignedBox3d& box = hull.rig().workspace_mm;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    for (const double face_mm : {box.min()[axis], box.max()[axis]})
      VisitMeetings(arc, Vector3d::Unit(axis), face_mm, [&](double angle_rad) {
        meetings.push_back({angle_rad, {}});
      });
  }
  std::ranges::sort(meetings, {}, &ArcMeeting::angle_rad);
  return meetings;
}

}  // namespace

Vector3d Arc::At(double angle_rad) const {
  return center_in_world + std::cos(angle_rad) * start_in_world + std::sin(angle_rad) * quarter_in_world;
}

std::optional<ArcExit> FirstOutside(const VisualHull& hull, const Arc& arc) {
  CrossingScratch own;
  return FirstOutside(hull, arc, &own);
}

std::optional<ArcExit> FirstOutside(const VisualHull& hull, const Arc& arc, CrossingScratch* scratch) {
  const double radius_mm = arc.start_in_world.norm();
  core::Require(radius_mm > 0.0 && std::abs(arc.quarter_in_world.norm() - radius_mm) <= kSkew * radius_mm &&
                    std::abs(arc.start_in_world.dot(arc.quarter_in_world)) <= kSkew * radius_mm * radius_mm,
                "an arc is part of a circle");
  if (hull.IsEmpty()) return ArcExit{};
  ArcMeeting last;
  const std::span<const ArcMeeting> meetings = MeetingsOf(hull, arc, scratch);
  const auto is_outside_up_to = [&](double angle_rad) {
    return angle_rad > last.angle_rad + kSameRad &&
           !hull.Contains(arc.At(0.5 * (last.angle_rad + angle_rad)));
  };
  for (const ArcMeeting& meeting : meetings) {
    if (is_outside_up_to(meeting.angle_rad)) return ArcExit{last.angle_rad, last.boundary};
    last = meeting;
  }
  if (is_outside_up_to(kTurnRad)) return ArcExit{last.angle_rad, last.boundary};
  return std::nullopt;
}

}  // namespace elbowroom::recon
