#include "app/control/measuring/measurement.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <memory>

#include "app/control/measuring/frame_dimensions.h"
#include "core/bvh.h"
#include "core/units.h"
#include "review/clearance.h"

namespace elbowroom::control {
namespace {

using Eigen::Vector3d;

struct PlaceInWorld {
  Vector3d point;
  Vector3d normal;
};

std::optional<PlaceInWorld> InWorld(const SurfacePlace& place, const FrameResult& result) {
  if (place.part >= result.world_from_parts.size()) return std::nullopt;
  const core::RigidTransform& world_from_part = result.world_from_parts[place.part];
  return PlaceInWorld{world_from_part * place.point_in_part, world_from_part.rotation * place.normal_in_part};
}

Dimension FacesOf(const PlaceInWorld& a, const PlaceInWorld& b) {
  // Of the planes, whichever sides are outer ones: from 0 to 90 degrees.
  const double angle_deg =
      core::DegreesFromRadians(std::atan2(a.normal.cross(b.normal).norm(), std::abs(a.normal.dot(b.normal))));
  if (angle_deg < kParallelDeg) {
    const double along_mm = a.normal.dot(b.point - a.point);
    return {
        a.point, a.point + along_mm * a.normal, fmt::format("{:.2f} mm, parallel", std::abs(along_mm)), {}};
  }
  return {a.point,
          b.point,
          fmt::format("{:.2f}°, {:.2f} mm between the places", angle_deg, (b.point - a.point).norm()),
          {}};
}

}  // namespace

std::optional<Dimension> MeasureNow(const Measurement& measurement, const FrameResult& result) {
  const std::optional<PlaceInWorld> a = InWorld(measurement.a, result), b = InWorld(measurement.b, result);
  if (!a || !b || measurement.kind == MeasurementKind::kPointHull) return std::nullopt;
  if (measurement.kind == MeasurementKind::kFaces) return FacesOf(*a, *b);
  return Dimension{a->point, b->point, fmt::format("{:.2f} mm", (b->point - a->point).norm()), {}};
}

std::optional<Dimension> MeasureToHull(const SurfacePlace& place, const FrameResult& result) {
  const std::optional<PlaceInWorld> at = InWorld(place, result);
  if (!at || result.hull == nullptr) return std::nullopt;
  auto point = std::make_shared<core::TriangleMesh>();
  point->vertices_mm = {at->point, at->point, at->point};
  point->triangles = {{0, 1, 2}};
  const review::Clearance found = review::FindClearance(*result.hull, core::TriangleTree(point), {});
  if (found.meets) return Dimension{at->point, at->point, "0 mm: in what is real", {}};
  if (!found.has_witnesses || !std::isfinite(found.interval.upper_mm)) return std::nullopt;
  return Dimension{at->point,
                   found.interval.witness_hull_in_world_mm,
                   IntervalText(found.interval.lower_mm, found.interval.upper_mm),
                   {}};
}

}  // namespace elbowroom::control
