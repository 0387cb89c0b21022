#include "recon/hull/ray_crossings.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/error.h"
#include "recon/contours/silhouette.h"
#include "recon/hull/camera_query.h"
#include "recon/hull/crossing_scratch.h"
#include "recon/hull/visual_hull.h"

namespace elbowroom::recon {
namespace {

using Eigen::Vector3d;

constexpr double kUnitSlack = 1e-9;
// A ray that passes a camera's centre this near, as a share of how far away it starts, counts as passing
// through it: rounding would decide the order in which it crosses the edges' surfaces, which all meet there.
constexpr double kThroughCentre = 1e-11;

// A ray in a camera's frame.
struct RayInCam {
  Vector3d origin;
  Vector3d direction;
};

bool PassesThroughCentre(const RayInCam& ray) {
  return ray.direction.cross(ray.origin).norm() <= kThroughCentre * ray.origin.norm();
}

// A ray through the camera's centre has one label up to the centre and one from there on: those of the two
// directions in which the camera sees the ray. Returns the label at the ray's origin.
bool AddCentreEvent(const ContourMap& labels, double focal_px, const RayInCam& ray, std::size_t camera,
                    bool is_outline, std::vector<RayCrossing>* events) {
  const bool before = LabelInCam(labels, focal_px, -ray.direction);
  const bool after = LabelInCam(labels, focal_px, ray.direction);
  const double t_mm = -ray.origin.dot(ray.direction);
  if (t_mm <= 0.0) return after;
  if (before != after) events->push_back({t_mm, camera, 0, after, is_outline});  // edge 0 stands for all
  return before;
}

// Derivation in docs/exact_view.md. With q a vertex's direction, the sign of (direction x centre) . q says on
// which side of the epipolar plane the vertex is; an edge whose ends are on different sides is crossed by the
// ray's line, and the order of the sides tells crossings of the edge's cone from those of its mirror image
// behind the camera. Returns the label before the first event.
bool AddEvents(const ContourMap& labels, double focal_px, const RayInCam& ray, std::size_t camera,
               bool is_outline, CrossingScratch* scratch) {
  const Contour& contour = labels.contour();
  const Vector3d centre = -ray.origin;
  const Vector3d side = ray.direction.cross(centre);
  std::vector<std::uint8_t>& is_positive = scratch->sides;
  is_positive.resize(contour.vertices.size());
  for (std::size_t i = 0; i < contour.vertices.size(); ++i) {
    const Eigen::Vector2d& v = contour.vertices[i];
    is_positive[i] = side.x() * v.x() + side.y() * v.y() + side.z() * focal_px > 0.0 ? 1 : 0;
  }
  double first_mm = std::numeric_limits<double>::infinity();
  bool first_is_entry = false, is_tied = false;
  for (std::uint32_t e = 0; e < contour.edges.size(); ++e) {
    const ContourEdge& edge = contour.edges[e];
    if (is_positive[edge.from] == is_positive[edge.to]) continue;
    const Eigen::Vector2d &a = contour.vertices[edge.from], &b = contour.vertices[edge.to];
    const Vector3d normal =
        Vector3d(a.x(), a.y(), focal_px).cross(Vector3d(b.x() - a.x(), b.y() - a.y(), 0.0));
    const double rise = normal.dot(ray.direction), height = normal.dot(centre);
    const bool is_entry = is_positive[edge.from] != 0;
    if (is_entry != (rise > 0.0)) continue;  // a crossing of the mirror image
    const double t_mm = height / rise;
    if (!(t_mm > 0.0)) continue;
    scratch->crossings.push_back({t_mm, camera, e, is_entry, is_outline});
    is_tied = t_mm == first_mm || (is_tied && t_mm > first_mm);
    if (t_mm >= first_mm) continue;
    first_mm = t_mm;
    first_is_entry = is_entry;
  }
  // If the first event is an entry, the label before it is background; if it is an exit, object.
  if (std::isfinite(first_mm) && !is_tied) return !first_is_entry;
  // Otherwise the label is asked halfway to the first event, or anywhere if there is none. It isn't asked at
  // the origin, which may be on the hull's surface.
  const double between_mm = std::isinf(first_mm) ? centre.norm() : 0.5 * first_mm;
  return LabelInCam(labels, focal_px, ray.origin + between_mm * ray.direction);
}

// The stretch of a ray inside a box (slab test); empty (from > to) if it misses.
RaySpan Clip(const Eigen::AlignedBox3d& box, const Ray& ray, RaySpan span) {
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const double origin = ray.origin_in_world[axis], direction = ray.direction_in_world[axis];
    if (direction == 0.0) {
      if (origin < box.min()[axis] || origin > box.max()[axis]) return {1.0, 0.0};
      continue;
    }
    const double a = (box.min()[axis] - origin) / direction, b = (box.max()[axis] - origin) / direction;
    span.from_mm = std::max(span.from_mm, std::min(a, b));
    span.to_mm = std::min(span.to_mm, std::max(a, b));
  }
  return span;
}

// Which cameras label the ray's present place object, and which of them see it.
class Votes {
 public:
  Votes(const VisualHull& hull, CrossingScratch* scratch)
      : asks_for_sight_(ExteriorIsObject(hull.rig())),
        objects_(scratch->objects),
        visibility_outlines_(scratch->outlines) {
    objects_.assign(hull.silhouettes().size(), 0);
    visibility_outlines_.assign(hull.silhouettes().size(), 0);
  }

  void Set(std::size_t camera, bool is_outline, bool value) {
    std::uint8_t& vote = is_outline ? visibility_outlines_[camera] : objects_[camera];
    (is_outline ? seen_ : inside_) += static_cast<int>(value) - static_cast<int>(vote);
    vote = value ? 1 : 0;
  }

  [[nodiscard]] bool AreInside() const {
    return inside_ == static_cast<int>(objects_.size()) && (!asks_for_sight_ || seen_ > 0);
  }

 private:
  bool asks_for_sight_;
  int inside_ = 0;
  int seen_ = 0;
  std::vector<std::uint8_t>& objects_;
  std::vector<std::uint8_t>& visibility_outlines_;
};

// Sets the votes to those where the ray starts. Returns all events beyond, in order, in the scratch's memory.
std::span<const RayCrossing> EventsAlong(const VisualHull& hull, const Ray& ray, Votes* votes,
                                         CrossingScratch* scratch) {
  std::vector<RayCrossing>& events = scratch->crossings;
  events.clear();
  for (std::size_t i = 0; i < hull.silhouettes().size(); ++i) {
    const core::RigidTransform& cam_from_world = hull.rig().cameras[i].cam_from_world();
    const RayInCam in_cam{cam_from_world * ray.origin_in_world,
                          cam_from_world.rotation * ray.direction_in_world};
    const UndistortedPlane& plane = hull.silhouettes()[i]->plane();
    const auto add = [&](const ContourMap& labels, bool is_outline) {
      if (PassesThroughCentre(in_cam)) {
        votes->Set(i, is_outline, AddCentreEvent(labels, plane.focal_px(), in_cam, i, is_outline, &events));
        return;
      }
      votes->Set(i, is_outline, AddEvents(labels, plane.focal_px(), in_cam, i, is_outline, scratch));
    };
    add(hull.silhouettes()[i]->labels(), false);
    if (ExteriorIsObject(hull.rig())) add(plane.outline(), true);
  }
  std::sort(events.begin(), events.end(),
            [](const RayCrossing& a, const RayCrossing& b) { return a.t_mm < b.t_mm; });
  return events;
}

HullBoundary BoundaryAt(const RayCrossing& event) { return {event.camera, event.edge, event.is_outline}; }

}  // namespace

std::vector<HullInterval> IntervalsInHull(const VisualHull& hull, const Ray& ray, const RaySpan& span) {
  CrossingScratch own;
  (void)IntervalsInHull(hull, ray, span, &own);
  return std::move(own.intervals);
}

std::span<const HullInterval> IntervalsInHull(const VisualHull& hull, const Ray& ray, const RaySpan& span,
                                              CrossingScratch* scratch) {
  core::Require(std::abs(ray.direction_in_world.norm() - 1.0) <= kUnitSlack, "a ray's direction is unit");
  core::Require(span.from_mm >= 0.0 && span.to_mm >= span.from_mm, "0 <= from <= to");
  std::vector<HullInterval>& intervals = scratch->intervals;
  intervals.clear();
  if (hull.IsEmpty()) return intervals;
  const RaySpan clipped = Clip(hull.rig().workspace_mm, ray, span);
  if (!(clipped.from_mm < clipped.to_mm)) return intervals;
  Votes votes(hull, scratch);
  const std::span<const RayCrossing> events = EventsAlong(hull, ray, &votes, scratch);
  std::size_t next = 0;
  for (; next < events.size() && events[next].t_mm <= clipped.from_mm; ++next)
    votes.Set(events[next].camera, events[next].is_outline, events[next].is_entry);
  HullInterval interval{clipped.from_mm, 0.0, {}, {}};
  bool is_inside = votes.AreInside();
  for (; next < events.size() && events[next].t_mm < clipped.to_mm; ++next) {
    const RayCrossing& event = events[next];
    votes.Set(event.camera, event.is_outline, event.is_entry);
    if (votes.AreInside() == is_inside) continue;
    is_inside = !is_inside;
    if (is_inside) {
      interval = {event.t_mm, 0.0, BoundaryAt(event), {}};
    } else if (event.t_mm > interval.from_mm) {
      interval.to_mm = event.t_mm, interval.exit = BoundaryAt(event);
      intervals.push_back(interval);
    }
  }
  if (is_inside) {
    interval.to_mm = clipped.to_mm;
    intervals.push_back(interval);
  }
  return intervals;
}

std::optional<double> FirstInside(const VisualHull& hull, const Ray& ray, const RaySpan& span) {
  CrossingScratch own;
  return FirstInside(hull, ray, span, &own);
}

std::optional<double> FirstInside(const VisualHull& hull, const Ray& ray, const RaySpan& span,
                                  CrossingScratch* scratch) {
  const std::span<const HullInterval> intervals = IntervalsInHull(hull, ray, span, scratch);
  if (intervals.empty()) return std::nullopt;
  return intervals.front().from_mm;
}

std::optional<double> FirstOutside(const VisualHull& hull, const Ray& ray, const RaySpan& span) {
  const std::vector<HullInterval> intervals = IntervalsInHull(hull, ray, span);
  double at_mm = span.from_mm;
  for (const HullInterval& interval : intervals) {
    if (interval.from_mm > at_mm) break;
    at_mm = interval.to_mm;
  }
  if (at_mm >= span.to_mm) return std::nullopt;
  return at_mm;
}

}  // namespace elbowroom::recon
