#include "tests/accuracy/disturbed_rig.h"

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <random>

#include "core/units.h"
#include "tests/accuracy/surface_picture.h"
#include "tests/oracles/first_along.h"

namespace elbowroom::accuracy {
namespace {

using Eigen::Vector3d;

Vector3d RandomDirection(std::mt19937_64* random) {
  std::normal_distribution<double> normal;
  Vector3d direction;
  do {
    direction = {normal(*random), normal(*random), normal(*random)};
  } while (direction.norm() < 1e-3);
  return direction.normalized();
}

core::CameraModel Moved(const core::CameraModel& camera, const Disturbance& disturbance,
                        std::mt19937_64* random) {
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(core::RadiansFromDegrees(disturbance.rotation_deg), RandomDirection(random))
          .toRotationMatrix();
  core::CameraCalibration moved = camera.calibration();
  moved.cam_from_world.rotation = turn * camera.cam_from_world().rotation;
  const Vector3d center_in_world =
      camera.center_in_world() + disturbance.position_mm * RandomDirection(random);
  moved.cam_from_world.translation_mm = -(moved.cam_from_world.rotation * center_in_world);
  return core::CameraModel(std::move(moved));
}

}  // namespace

core::CameraModel DisturbedCamera(const core::CameraModel& camera, const Disturbance& disturbance,
                                  std::uint64_t seed) {
  std::mt19937_64 random(seed);
  return Moved(camera, disturbance, &random);
}

std::vector<oracles::Sight> DisturbedSights(const core::Rig& rig, std::span<const recon::Solid> solids,
                                            const Disturbance& disturbance, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> late(-0.5, 0.5);
  std::vector<oracles::Sight> sights;
  for (const core::CameraModel& camera : rig.cameras) {
    oracles::Sight sight{
        Moved(camera, disturbance, &random), camera.cam_from_world(), {solids.begin(), solids.end()}};
    const Vector3d shift_mm = late(random) * disturbance.skew_s * disturbance.velocity_mm_s;
    for (recon::Solid& solid : sight.solids) solid.world_from_solid.translation_mm += shift_mm;
    sights.push_back(std::move(sight));
  }
  return sights;
}

std::shared_ptr<const core::Rig> BelievedRig(const core::Rig& rig, std::span<const oracles::Sight> sights) {
  auto believed = std::make_shared<core::Rig>(rig);
  believed->cameras.clear();
  for (const oracles::Sight& sight : sights) believed->cameras.push_back(sight.believed);
  return believed;
}

std::optional<double> NearestHitMm(std::span<const recon::Solid> solids, const recon::Ray& ray) {
  double nearest_mm = std::numeric_limits<double>::infinity();
  for (const recon::Solid& solid : solids) {
    if (const auto hit = recon::FirstHit(solid, ray)) nearest_mm = std::min(nearest_mm, hit->distance_mm);
  }
  if (!std::isfinite(nearest_mm)) return std::nullopt;
  return nearest_mm;
}

recon::DepthMap PictureOnPlanes(const core::CameraModel& view, const Eigen::AlignedBox3d& workspace_mm,
                                double spacing_mm, const std::function<bool(const Vector3d&)>& contains,
                                int stride) {
  const Vector3d forward = view.cam_from_world().rotation.row(2).transpose();
  const auto first_plane = [&](const recon::Ray& ray) -> std::optional<double> {
    const auto span = oracles::ClipToBox(workspace_mm, ray, 0.0);
    if (!span) return std::nullopt;
    const double along = ray.direction_in_world.dot(forward);  // depth per mm of ray
    const double last_mm = static_cast<double>(span->second);
    for (double plane = std::ceil(static_cast<double>(span->first) * along / spacing_mm);; plane += 1.0) {
      const double t_mm = plane * spacing_mm / along;
      if (t_mm > last_mm) return std::nullopt;
      if (contains(ray.origin_in_world + t_mm * ray.direction_in_world)) return t_mm;
    }
  };
  return PictureOf(view, first_plane, stride);
}

}  // namespace elbowroom::accuracy
