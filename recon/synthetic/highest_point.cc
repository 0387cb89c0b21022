#include "recon/synthetic/highest_point.h"

#include <algorithm>
#include <array>
#include <cmath>
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

// Where vertical lines through the rectangle's corners enter the solid.
Height HighestAboveCorners(const Solid& solid, const AlignedBox2d& above) {
  const BoundingSphere sphere = BoundingSphereOf(solid);
  const double over_z = sphere.center_in_world.z() + 2.0 * sphere.radius_mm;
  Height highest;
  for (const auto corner :
       {AlignedBox2d::BottomLeft, AlignedBox2d::BottomRight, AlignedBox2d::TopLeft, AlignedBox2d::TopRight}) {
    const Eigen::Vector2d at = above.corner(corner);
    const auto hit = FirstHit(solid, Ray{{at.x(), at.y(), over_z}, -Vector3d::UnitZ()});
    if (hit) TakeHigher(over_z - hit->distance_mm, &highest);
  }
  return highest;
}

// Of the points in which a circle meets the sides of the prism above the rectangle. `across`: its radii along
// two axes.
Height HighestOfCircleOnBorder(const Vector3d& center, const std::array<Vector3d, 2>& across,
                               const AlignedBox2d& above) {
  Height highest;
  for (const int axis : {0, 1}) {
    const double most = std::hypot(across[0][axis], across[1][axis]);
    const double top_rad = std::atan2(across[1][axis], across[0][axis]);
    for (const double border : {above.min()[axis], above.max()[axis]}) {
      const double off = border - center[axis];
      if (most == 0.0 || std::abs(off) > most) continue;
      for (const double turn_rad : {std::acos(off / most), -std::acos(off / most)}) {
        Vector3d at =
            center + std::cos(top_rad + turn_rad) * across[0] + std::sin(top_rad + turn_rad) * across[1];
        at[axis] = border;
        if (above.contains(Eigen::Vector2d(at.head<2>()))) TakeHigher(at.z(), &highest);
      }
    }
  }
  return highest;
}

// A full tube is convex, and so is what of it is above the rectangle. That is highest where the tube itself
// is, which is an end of its side's upper line; or on a side of the prism above the rectangle: where a rim
// meets it, or where a line of the tube's side does whose tangent plane holds that prism's level direction;
// or on an edge of the prism.
Height HighestOfTube(Solid solid, Tube tube, const AlignedBox2d& above) {
  tube.inner_radius_mm = 0.0;
  solid.shape = tube;
  const RigidTransform& world_from_solid = solid.world_from_solid;
  const Vector3d start = world_from_solid.translation_mm,
                 axis = world_from_solid.rotation * Vector3d::UnitZ(), end = start + tube.length_mm * axis;
  const Vector3d up = Vector3d::UnitZ();
  Height highest = HighestAboveCorners(solid, above);
  for (const Vector3d& normal : {Vector3d(up - axis.z() * axis), Vector3d(axis.cross(Vector3d::UnitX())),
                                 Vector3d(axis.cross(Vector3d::UnitY()))}) {
    if (normal.norm() == 0.0) continue;
    for (const double sign : {-1.0, 1.0}) {
      const Vector3d side = sign * tube.outer_radius_mm * normal.normalized();
      TakeHigher(HighestOfSegment(start + side, end + side, above), &highest);
    }
  }
  const std::array<Vector3d, 2> across{world_from_solid.rotation * Vector3d(tube.outer_radius_mm, 0.0, 0.0),
                                       world_from_solid.rotation * Vector3d(0.0, tube.outer_radius_mm, 0.0)};
  for (const Vector3d& middle : {start, end})
    TakeHigher(HighestOfCircleOnBorder(middle, across, above), &highest);
  return highest;
}

// A box above a rectangle has its highest point on an edge of the box, or where an edge of the prism above
// the rectangle enters the box.
Height HighestOfBox(const Solid& solid, const Box& box, const AlignedBox2d& above) {
  Height highest = HighestAboveCorners(solid, above);
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
  if (const auto* tube = std::get_if<Tube>(&solid.shape)) return HighestOfTube(solid, *tube, above_mm);
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
