#include "recon/synthetic/solids.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/error.h"

namespace elbowroom::recon {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// Two pieces of one surface share a seam: without this slack a ray through the seam could slip between them.
constexpr double kSeamMm = 1e-9;

// The nearest of the surface points offered so far; all in the solid's frame.
struct Nearest {
  double distance_mm = std::numeric_limits<double>::infinity();
  Vector3d normal = Vector3d::UnitZ();

  [[nodiscard]] bool Improves(double distance) const { return distance >= 0.0 && distance < distance_mm; }
  void Take(double distance, const Vector3d& normal_in_solid) {
    distance_mm = distance;
    normal = normal_in_solid;
  }
};

// Roots of |o + t d|^2 = radius^2 in ascending order; nothing if the line stays outside or |d| is zero.
template <typename Vector>
std::optional<std::array<double, 2>> RoundRoots(const Vector& o, const Vector& d, double radius) {
  const double a = d.squaredNorm();
  if (a < 1e-24) return std::nullopt;
  const double b = o.dot(d);
  const double discriminant = b * b - a * (o.squaredNorm() - radius * radius);
  if (discriminant < 0.0) return std::nullopt;
  const double root = std::sqrt(discriminant);
  return std::array<double, 2>{(-b - root) / a, (-b + root) / a};
}

// The part of a sphere's surface about `center` with z_min <= z <= z_max.
void OfferSphere(const Vector3d& o, const Vector3d& d, const Vector3d& center, double radius, double z_min,
                 double z_max, Nearest& nearest) {
  const Vector3d from_center = o - center;
  const auto roots = RoundRoots(from_center, d, radius);
  if (!roots) return;
  for (const double t : *roots) {
    if (!nearest.Improves(t)) continue;
    const double z = o.z() + t * d.z();
    if (z < z_min - kSeamMm || z > z_max + kSeamMm) continue;
    nearest.Take(t, (from_center + t * d) / radius);
  }
}

// The lateral surface of a cylinder about z from 0 to length; `outward` is -1 for the wall of a bore.
void OfferLateral(const Vector3d& o, const Vector3d& d, double radius, double length, double outward,
                  Nearest& nearest) {
  const Vector2d o_flat = o.head<2>();
  const Vector2d d_flat = d.head<2>();
  const auto roots = RoundRoots(o_flat, d_flat, radius);
  if (!roots) return;
  for (const double t : *roots) {
    if (!nearest.Improves(t)) continue;
    const double z = o.z() + t * d.z();
    if (z < -kSeamMm || z > length + kSeamMm) continue;
    const Vector2d radial = (o_flat + t * d_flat) * (outward / radius);
    nearest.Take(t, {radial.x(), radial.y(), 0.0});
  }
}

void Offer(const Sphere& sphere, const Vector3d& o, const Vector3d& d, Nearest& nearest) {
  constexpr double kEverywhere = std::numeric_limits<double>::infinity();
  OfferSphere(o, d, Vector3d::Zero(), sphere.radius_mm, -kEverywhere, kEverywhere, nearest);
}

void Offer(const Capsule& capsule, const Vector3d& o, const Vector3d& d, Nearest& nearest) {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  const double length = capsule.length_mm;
  OfferLateral(o, d, capsule.radius_mm, length, 1.0, nearest);
  OfferSphere(o, d, Vector3d::Zero(), capsule.radius_mm, -kFar, 0.0, nearest);
  OfferSphere(o, d, {0.0, 0.0, length}, capsule.radius_mm, length, kFar, nearest);
}

void Offer(const Tube& tube, const Vector3d& o, const Vector3d& d, Nearest& nearest) {
  OfferLateral(o, d, tube.outer_radius_mm, tube.length_mm, 1.0, nearest);
  if (tube.inner_radius_mm > 0.0) OfferLateral(o, d, tube.inner_radius_mm, tube.length_mm, -1.0, nearest);
  if (d.z() == 0.0) return;
  for (const double z : {0.0, tube.length_mm}) {
    const double t = (z - o.z()) / d.z();
    if (!nearest.Improves(t)) continue;
    const double rho = (o.head<2>() + t * d.head<2>()).norm();
    if (rho < tube.inner_radius_mm - kSeamMm || rho > tube.outer_radius_mm + kSeamMm) continue;
    nearest.Take(t, Vector3d::UnitZ() * (z == 0.0 ? -1.0 : 1.0));
  }
}

void Offer(const Box& box, const Vector3d& o, const Vector3d& d, Nearest& nearest) {
  const Vector3d half = 0.5 * box.size_mm;
  for (int axis = 0; axis < 3; ++axis) {
    if (d[axis] == 0.0) continue;
    for (const double side : {-1.0, 1.0}) {
      const double t = (side * half[axis] - o[axis]) / d[axis];
      if (!nearest.Improves(t)) continue;
      Vector3d beyond = (o + t * d).cwiseAbs() - half;
      beyond[axis] = 0.0;
      if (beyond.maxCoeff() <= kSeamMm) nearest.Take(t, side * Vector3d::Unit(axis));
    }
  }
}

double Distance(const Sphere& sphere, const Vector3d& x) { return x.norm() - sphere.radius_mm; }

double Distance(const Capsule& capsule, const Vector3d& x) {
  const double z_on_axis = std::clamp(x.z(), 0.0, capsule.length_mm);
  return (x - Vector3d(0.0, 0.0, z_on_axis)).norm() - capsule.radius_mm;
}

// A box about the origin, in any dimension: outside the length of what sticks out, inside the nearest face.
template <typename Vector>
double BoxDistance(const Vector& x, const Vector& half) {
  const Vector beyond = x.cwiseAbs() - half;
  return beyond.cwiseMax(0.0).norm() + std::min(beyond.maxCoeff(), 0.0);
}

double Distance(const Tube& tube, const Vector3d& x) {
  // In the half-plane through the axis the tube is a rectangle; a full cylinder's reaches across the axis.
  const double inner = tube.inner_radius_mm > 0.0 ? tube.inner_radius_mm : -tube.outer_radius_mm;
  const Vector2d middle(0.5 * (inner + tube.outer_radius_mm), 0.5 * tube.length_mm);
  const Vector2d half(0.5 * (tube.outer_radius_mm - inner), 0.5 * tube.length_mm);
  const Vector2d flat(x.head<2>().norm(), x.z());
  return BoxDistance(Vector2d(flat - middle), half);
}

double Distance(const Box& box, const Vector3d& x) { return BoxDistance(x, Vector3d(0.5 * box.size_mm)); }

BoundingSphere Bounds(const Sphere& sphere) { return {Vector3d::Zero(), sphere.radius_mm}; }
BoundingSphere Bounds(const Capsule& capsule) {
  return {{0.0, 0.0, 0.5 * capsule.length_mm}, 0.5 * capsule.length_mm + capsule.radius_mm};
}
BoundingSphere Bounds(const Tube& tube) {
  return {{0.0, 0.0, 0.5 * tube.length_mm}, std::hypot(0.5 * tube.length_mm, tube.outer_radius_mm)};
}
BoundingSphere Bounds(const Box& box) { return {Vector3d::Zero(), 0.5 * box.size_mm.norm()}; }

}  // namespace

std::optional<RayHit> FirstHit(const Solid& solid, const Ray& ray) {
  const Eigen::Matrix3d& world_from_solid = solid.world_from_solid.rotation;
  const Vector3d origin_in_solid =
      world_from_solid.transpose() * (ray.origin_in_world - solid.world_from_solid.translation_mm);
  const Vector3d direction_in_solid = world_from_solid.transpose() * ray.direction_in_world;
  Nearest nearest;
  std::visit([&](const auto& shape) { Offer(shape, origin_in_solid, direction_in_solid, nearest); },
             solid.shape);
  if (!std::isfinite(nearest.distance_mm)) return std::nullopt;
  return RayHit{nearest.distance_mm, world_from_solid * nearest.normal};
}

double SignedDistanceMm(const Solid& solid, const Vector3d& x_in_world) {
  const Vector3d x_in_solid =
      solid.world_from_solid.rotation.transpose() * (x_in_world - solid.world_from_solid.translation_mm);
  return std::visit([&](const auto& shape) { return Distance(shape, x_in_solid); }, solid.shape);
}

bool Contains(const Solid& solid, const Vector3d& x_in_world) {
  return SignedDistanceMm(solid, x_in_world) <= 0.0;
}

bool Contains(std::span<const SyntheticObject> objects, const Vector3d& x_in_world) {
  return std::ranges::any_of(objects, [&](const SyntheticObject& object) {
    return std::ranges::any_of(object.solids, [&](const Solid& s) { return Contains(s, x_in_world); });
  });
}

BoundingSphere BoundingSphereOf(const Solid& solid) {
  BoundingSphere sphere = std::visit([](const auto& shape) { return Bounds(shape); }, solid.shape);
  sphere.center_in_world = solid.world_from_solid * sphere.center_in_world;
  return sphere;
}

Solid CapsuleBetween(const Vector3d& a_in_world, const Vector3d& b_in_world, double radius_mm,
                     const Vector3d& color_bgr) {
  const Vector3d along = b_in_world - a_in_world;
  core::Require(along.norm() > 0.0, "a capsule's end points differ");
  const Eigen::Matrix3d rotation =
      Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), along).toRotationMatrix();
  return {Capsule{radius_mm, along.norm()}, {rotation, a_in_world}, color_bgr};
}

std::vector<Solid> AllSolids(std::span<const SyntheticObject> objects) {
  std::vector<Solid> solids;
  for (const SyntheticObject& object : objects) {
    solids.insert(solids.end(), object.solids.begin(), object.solids.end());
  }
  return solids;
}

}  // namespace elbowroom::recon
