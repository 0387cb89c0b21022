#include "recon/synthetic/table_scene.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

#include "recon/synthetic/sensor_noise.h"

namespace elbowroom::recon {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kTableHalfXMm = 1100.0;
constexpr double kTableHalfYMm = 900.0;
const Vector3d kToLampInWorld = Vector3d(0.30, -0.35, 0.89).normalized();

// Smoothly interpolated random values at integer positions, 0 to 1.
double ValueNoise(std::uint64_t seed, const Vector2d& at) {
  const double x0 = std::floor(at.x());
  const double y0 = std::floor(at.y());
  const auto corner = [&](double dx, double dy) {
    return UniformFrom(StreamSeed(seed, static_cast<std::int64_t>(x0 + dx),
                                  static_cast<std::uint64_t>(static_cast<std::int64_t>(y0 + dy)), 0));
  };
  const auto ease = [](double t) { return t * t * (3.0 - 2.0 * t); };
  const double u = ease(at.x() - x0);
  const double v = ease(at.y() - y0);
  return (1 - v) * ((1 - u) * corner(0, 0) + u * corner(1, 0)) +
         v * ((1 - u) * corner(0, 1) + u * corner(1, 1));
}

std::optional<Vector2d> TablePoint(const Ray& ray) {
  if (ray.direction_in_world.z() >= -1e-6) return std::nullopt;
  const double distance = -ray.origin_in_world.z() / ray.direction_in_world.z();
  const Vector2d point = (ray.origin_in_world + distance * ray.direction_in_world).head<2>();
  if (std::abs(point.x()) > kTableHalfXMm || std::abs(point.y()) > kTableHalfYMm) return std::nullopt;
  return point;
}

// The lamp is a disc; these points of it stand for its area.
constexpr double kLampRadius = 0.12;  // as seen from the table, per unit distance
constexpr std::array<std::array<double, 2>, 8> kLampPoints{
    {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {0.5, 0.5}, {-0.5, 0.5}, {0.5, -0.5}, {-0.5, -0.5}}};

Vector3d ToLampPoint(std::size_t k) {
  static const Vector3d aside = kToLampInWorld.cross(Vector3d::UnitX()).normalized();
  static const Vector3d across = kToLampInWorld.cross(aside);
  const auto& [u, v] = kLampPoints[k];
  return (kToLampInWorld + kLampRadius * (u * aside + v * across)).normalized();
}

}  // namespace

Eigen::Vector3f EmptySceneColor(std::uint64_t seed, const Ray& ray) {
  if (const auto point = TablePoint(ray)) {
    const double cloth = 8.0 * ValueNoise(seed, *point / 90.0) + 8.0 * ValueNoise(seed + 1, *point / 11.0);
    return Eigen::Vector3d(36.0 + cloth, 28.0 + cloth, 24.0 + cloth).cast<float>();
  }
  const Vector3d& d = ray.direction_in_world;
  const Vector2d on_wall(12.0 * std::atan2(d.y(), d.x()), 14.0 * d.z());
  const double wall = 10.0 * ValueNoise(seed + 2, on_wall) + 4.0 * ValueNoise(seed + 3, 9.0 * on_wall);
  return Eigen::Vector3d(18.0 + wall, 20.0 + wall, 22.0 + wall).cast<float>();
}

Eigen::Vector3f ShadedColor(const Vector3d& color_bgr, const Vector3d& normal_in_world) {
  const double light = 0.55 + 0.45 * std::max(0.0, normal_in_world.dot(kToLampInWorld));
  return (light * color_bgr).cast<float>();
}

std::optional<TableDisc> DiscOnTable(std::span<const Ray> rays) {
  Eigen::AlignedBox2d box;
  for (const Ray& ray : rays)
    if (const auto point = TablePoint(ray)) box.extend(*point);
  if (box.isEmpty()) return std::nullopt;
  const Vector2d center = box.center();
  constexpr double kRoundingMm = 1e-6;
  return TableDisc{{center.x(), center.y(), 0.0}, 0.5 * box.diagonal().norm() + kRoundingMm};
}

// The lamp's points lie within a cone around its axis. From another point of the disc the sphere is at most
// the disc's radius farther along the axis, and at most as much nearer to it.
bool MayShade(const BoundingSphere& sphere, const TableDisc& disc) {
  const Vector3d to_sphere = sphere.center_in_world - disc.center_in_world;
  const double along = to_sphere.dot(kToLampInWorld);
  const double beside = (to_sphere - along * kToLampInWorld).norm() - disc.radius_mm;
  return beside <=
         kLampRadius * (std::max(along + disc.radius_mm, 0.0) + sphere.radius_mm) + sphere.radius_mm;
}

float TableLight(const Ray& ray, std::span<const Solid> solids, std::span<const BoundingSphere> spheres) {
  constexpr float kShadowDepth = 0.5F;  // full umbra takes half the light
  const auto point = TablePoint(ray);
  if (!point) return 1.0F;
  const Vector3d x_in_world(point->x(), point->y(), 0.0);
  std::array<bool, kLampPoints.size()> blocked{};
  for (std::size_t i = 0; i < solids.size(); ++i) {
    if (!MayShade(spheres[i], {x_in_world, 0.0})) continue;
    for (std::size_t k = 0; k < kLampPoints.size(); ++k) {
      blocked[k] = blocked[k] || FirstHit(solids[i], {x_in_world, ToLampPoint(k)});
    }
  }
  const auto count = static_cast<float>(std::ranges::count(blocked, true));
  return 1.0F - kShadowDepth * count / static_cast<float>(kLampPoints.size());
}

}  // namespace elbowroom::recon
