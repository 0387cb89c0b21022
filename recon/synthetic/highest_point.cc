#include "recon/synthetic/highest_point.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>
#include <variant>

namespace elbowroom::recon {
namespace {

using core::RigidTransform;
using Eigen::AlignedBox2d;
using Eigen::Vector3d;

using Height = std::optional<double>;

void TakeHigher(const Height& height, Height* highest) {
  if (height && (!*highest || **highest < *height)) *highest = height;
}

// Of the part of a segment that is above the rectangle: it ends there, or at the rectangle's border.
Height HighestOfSegment(const Vector3d& a, const Vector3d& b, const AlignedBox2d& above) {
  double from = 0.0, to = 1.0;
  for (const int axis : {0, 1}) {
    const double along = b[axis] - a[axis];
    double first = above.min()[axis] - a[axis], last = above.max()[axis] - a[axis];
    if (along == 0.0) {
      if (first > 0.0 || last < 0.0) return std::nullopt;
      continue;
    }
    if (along < 0.0) std::swap(first, last);
    from = std::max(from, first / along);
    to = std::min(to, last / along);
  }
  if (from > to) return std::nullopt;
  return std::max(a.z() + from * (b.z() - a.z()), a.z() + to * (b.z() - a.z()));
}

// Of a ball: above the point of the rectangle that is nearest to its centre.
Height HighestOfBall(const Vector3d& center, double radius, const AlignedBox2d& above) {
  const double beside2 = above.squaredExteriorDistance(Eigen::Vector2d(center.head<2>()));
  if (beside2 > radius * radius) return std::nullopt;
  return center.z() + std::sqrt(radius * radius - beside2);
}

// A capsule is the union of the balls on its segment. How far a ball is beside the rectangle is convex along
// it, and the height above it concave, where there is any: both are found by dividing in three.
Height HighestOfCapsule(const Capsule& capsule, const RigidTransform& world_from_solid,
                        const AlignedBox2d& above) {
  constexpr int kSteps = 90;  // of which each leaves two thirds: to the last bit
  const auto center = [&](double z) -> Vector3d { return world_from_solid * Vector3d(0.0, 0.0, z); };
  const auto greatest = [&](double low, double high, const auto& value) {
    for (int step = 0; step < kSteps; ++step) {
      const double a = low + (high - low) / 3.0, b = high - (high - low) / 3.0;
      if (value(a) < value(b))
        low = a;
      else
        high = b;
    }
    return 0.5 * (low + high);
  };
  const auto beside2 = [&](double z) {
    return above.squaredExteriorDistance(Eigen::Vector2d(center(z).head<2>()));
  };
  const double nearest = greatest(0.0, capsule.length_mm, [&](double z) { return -beside2(z); });
  const double radius2 = capsule.radius_mm * capsule.radius_mm;
  if (beside2(nearest) > radius2) return std::nullopt;
  // The balls that reach above it: around the nearest one, to where their distance is the radius.
  const auto last_within = [&](double within, double beyond) {
    if (beside2(beyond) <= radius2) return beyond;
    for (int step = 0; step < kSteps; ++step) {
      const double middle = 0.5 * (within + beyond);
      (beside2(middle) <= radius2 ? within : beyond) = middle;
    }
    return within;
  };
  const auto height = [&](double z) {
    return HighestOfBall(center(z), capsule.radius_mm, above).value_or(center(z).z());
  };
  const double low = last_within(nearest, 0.0), high = last_within(nearest, capsule.length_mm);
  return std::max({height(low), height(high), height(greatest(low, high, height))});
}

Height HighestOfTube(const Tube& tube, const RigidTransform& world_from_solid, const AlignedBox2d& above) {
  constexpr int kLines = 720;
  Height highest;
  for (int i = 0; i < kLines; ++i) {
    const double angle_rad = 2.0 * std::numbers::pi * i / kLines;
    const Vector3d side(tube.outer_radius_mm * std::cos(angle_rad),
                        tube.outer_radius_mm * std::sin(angle_rad), 0.0);
    const Vector3d up(0.0, 0.0, tube.length_mm);
    // Lines of the side, and of the ends from their middle out.
    TakeHigher(HighestOfSegment(world_from_solid * side, world_from_solid * (side + up), above), &highest);
    for (const Vector3d& end : {Vector3d::Zero().eval(), up})
      TakeHigher(HighestOfSegment(world_from_solid * end, world_from_solid * (end + side), above), &highest);
  }
  return highest;
}

// A box above a rectangle has its highest point on an edge of the box, or where an edge of the prism above
// the rectangle enters the box.
Height HighestOfBox(const Solid& solid, const Box& box, const AlignedBox2d& above) {
  const BoundingSphere sphere = BoundingSphereOf(solid);
  const double over_z = sphere.center_in_world.z() + 2.0 * sphere.radius_mm;
  Height highest;
  for (const auto corner :
       {AlignedBox2d::BottomLeft, AlignedBox2d::BottomRight, AlignedBox2d::TopLeft, AlignedBox2d::TopRight}) {
    const Eigen::Vector2d at = above.corner(corner);
    const auto hit = FirstHit(solid, Ray{{at.x(), at.y(), over_z}, -Vector3d::UnitZ()});
    if (hit) TakeHigher(over_z - hit->distance_mm, &highest);
  }
  const auto corner = [&](unsigned i) -> Vector3d {
    const Vector3d sign((i & 1U) != 0U ? 0.5 : -0.5, (i & 2U) != 0U ? 0.5 : -0.5,
                        (i & 4U) != 0U ? 0.5 : -0.5);
    return solid.world_from_solid * Vector3d(sign.cwiseProduct(box.size_mm));
  };
  for (unsigned i = 0; i < 8; ++i)
    for (const unsigned axis : {1U, 2U, 4U})
      if ((i & axis) == 0U) TakeHigher(HighestOfSegment(corner(i), corner(i | axis), above), &highest);
  return highest;
}

}  // namespace

std::optional<double> HighestZMm(const Solid& solid, const AlignedBox2d& above_mm) {
  const RigidTransform& world_from_solid = solid.world_from_solid;
  if (const auto* sphere = std::get_if<Sphere>(&solid.shape))
    return HighestOfBall(world_from_solid.translation_mm, sphere->radius_mm, above_mm);
  if (const auto* capsule = std::get_if<Capsule>(&solid.shape))
    return HighestOfCapsule(*capsule, world_from_solid, above_mm);
  if (const auto* tube = std::get_if<Tube>(&solid.shape))
    return HighestOfTube(*tube, world_from_solid, above_mm);
  return HighestOfBox(solid, std::get<Box>(solid.shape), above_mm);
}

std::optional<double> HighestZMm(std::span<const SyntheticObject> objects, const AlignedBox2d& above_mm) {
  Height highest;
  for (const SyntheticObject& object : objects) {
    for (const Solid& solid : object.solids) {
      // Most can't reach higher than what was found.
      const BoundingSphere sphere = BoundingSphereOf(solid);
      if (highest && sphere.center_in_world.z() + sphere.radius_mm <= *highest) continue;
      TakeHigher(HighestZMm(solid, above_mm), &highest);
    }
  }
  return highest;
}

}  // namespace elbowroom::recon
