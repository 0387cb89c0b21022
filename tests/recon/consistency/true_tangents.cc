#include "tests/recon/consistency/true_tangents.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include "core/error.h"

namespace elbowroom::recon::testing {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kInfinite = std::numeric_limits<double>::infinity();

// All places where the boundary crosses a line between two neighbouring pixel centres.
std::vector<Vector2d> Crossings(const core::SoftMask& soft) {
  const core::BitMask boundary = core::BoundaryPixels(soft.mask);
  std::map<std::pair<int, int>, double> level;
  std::size_t next = 0;
  for (int y = 0; y < boundary.height_px(); ++y)
    for (int x = 0; x < boundary.width_px(); ++x)
      if (boundary.At(x, y)) level[{x, y}] = soft.levels.empty() ? 0.0 : soft.levels[next++];
  std::vector<Vector2d> crossings;
  for (const auto& [pixel, here] : level) {
    for (const auto& [dx, dy] : {std::pair(1, 0), std::pair(0, 1)}) {
      const int x = pixel.first + dx, y = pixel.second + dy;
      if (x >= soft.mask.width_px() || y >= soft.mask.height_px()) continue;
      if (soft.mask.At(x, y) == soft.mask.At(pixel.first, pixel.second)) continue;
      const double there = level.at({x, y});
      const double share = soft.levels.empty() ? 0.5 : (here - 127.5) / (here - there);
      crossings.emplace_back(pixel.first + share * dx, pixel.second + share * dy);
    }
  }
  return crossings;
}

}  // namespace

std::array<double, kTangentSides> TrueAnglesRad(const EpipolarPair& pair, const Vector3d& center_a_in_world,
                                                std::span<const Solid> solids) {
  std::array<double, kTangentSides> angles{kInfinite, -kInfinite};
  const auto add = [&](const Vector3d& center_in_world, double radius_mm) {
    const Vector3d from_a = center_in_world - center_a_in_world;
    const double x = from_a.dot(pair.zero), y = from_a.dot(pair.quarter);
    const double middle = std::atan2(y, x), half = std::asin(radius_mm / std::hypot(x, y));
    angles[0] = std::min(angles[0], middle - half);
    angles[1] = std::max(angles[1], middle + half);
  };
  for (const Solid& solid : solids) {
    const Vector3d& origin = solid.world_from_solid.translation_mm;
    if (const auto* sphere = std::get_if<Sphere>(&solid.shape)) {
      add(origin, sphere->radius_mm);
      continue;
    }
    const auto* capsule = std::get_if<Capsule>(&solid.shape);
    core::Require(capsule != nullptr, "only spheres and capsules have true tangents here");
    add(origin, capsule->radius_mm);
    add(origin + capsule->length_mm * solid.world_from_solid.rotation.col(2), capsule->radius_mm);
  }
  return angles;
}

std::array<double, kTangentSides> SlowAnglesRad(const core::CameraModel& camera,
                                                const core::CameraModel& other, const Vector3d& zero_in_world,
                                                const core::SoftMask& mask) {
  const Vector3d baseline = other.center_in_world() - camera.center_in_world();
  const Vector3d zero_normal = baseline.cross(zero_in_world).normalized();
  std::array<double, kTangentSides> angles{kInfinite, -kInfinite};
  for (const Vector2d& pixel : Crossings(mask)) {
    const std::optional<Vector2d> normalised = camera.NormalisedFromPixel(pixel);
    if (!normalised) continue;
    const Vector3d sight =
        camera.cam_from_world().rotation.transpose() * Vector3d(normalised->x(), normalised->y(), 1.0);
    const Vector3d normal = baseline.cross(sight).normalized();
    const double sine = zero_normal.cross(normal).dot(baseline.normalized());
    const double angle_rad = std::atan2(sine, zero_normal.dot(normal));
    angles[0] = std::min(angles[0], angle_rad);
    angles[1] = std::max(angles[1], angle_rad);
  }
  return angles;
}

}  // namespace elbowroom::recon::testing
