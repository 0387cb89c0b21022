#include "tests/recon/consistency/capsule_masks.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "core/error.h"

namespace elbowroom::recon::testing {
namespace {

using Eigen::Vector3d;

std::uint64_t Mix(std::uint64_t x) {  // splitmix64
  x += 0x9e3779b97f4a7c15ULL;
  x = (x ^ (x >> 30U)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27U)) * 0x94d049bb133111ebULL;
  return x ^ (x >> 31U);
}

// All points within radius_mm of a segment.
struct CapsuleInCam {
  Vector3d from = Vector3d::Zero(), along = Vector3d::Zero();
  double radius_mm = 0.0;
};

CapsuleInCam CapsuleOf(const Solid& solid, const core::RigidTransform& cam_from_world) {
  const core::RigidTransform cam_from_solid = cam_from_world * solid.world_from_solid;
  if (const auto* sphere = std::get_if<Sphere>(&solid.shape))
    return {cam_from_solid.translation_mm, Vector3d::Zero(), sphere->radius_mm};
  const auto* capsule = std::get_if<Capsule>(&solid.shape);
  core::Require(capsule != nullptr, "only spheres and capsules are drawn here");
  return {cam_from_solid.translation_mm, capsule->length_mm * cam_from_solid.rotation.col(2),
          capsule->radius_mm};
}

// How far inside the capsule's outline the ray through the camera's centre is, in px: its gap to the
// segment, seen from the camera.
double InsidePx(const CapsuleInCam& capsule, const Vector3d& ray, double focal_px) {
  // The points ray * s and from + along * t that are nearest to each other.
  const double to_ray = ray.dot(capsule.along), length2 = capsule.along.squaredNorm();
  const double denominator = length2 - to_ray * to_ray;
  double t = 0.0;
  if (denominator > 1e-12 * length2 && length2 > 0.0) {
    t = (ray.dot(capsule.from) * to_ray - capsule.along.dot(capsule.from)) / denominator;
    t = std::clamp(t, 0.0, 1.0);
  }
  const Vector3d nearest = capsule.from + t * capsule.along;
  const double along_ray = nearest.dot(ray);
  const double gap2 = nearest.squaredNorm() - along_ray * along_ray;
  const double gap_mm = std::sqrt(std::max(gap2, 0.0));
  // The outline is where the gap is the radius; there the ray is inclined against the axis by 1 / ray.z.
  return (capsule.radius_mm - gap_mm) * focal_px / (along_ray * ray.z());
}

struct PixelBox {
  int x0, y0, x1, y1;  // [x0, x1) x [y0, y1)
};

PixelBox BoxAround(const CapsuleInCam& capsule, const core::CameraModel& camera, double focal_px) {
  constexpr double kSlackPx = 8.0;
  PixelBox box{camera.width_px(), camera.height_px(), 0, 0};
  for (const Vector3d& end : {capsule.from, Vector3d(capsule.from + capsule.along)}) {
    const std::optional<Eigen::Vector2d> pixel = camera.ProjectInCam(end);
    if (!pixel || end.z() <= 2.0 * capsule.radius_mm) return {0, 0, camera.width_px(), camera.height_px()};
    const double reach_px = 1.5 * capsule.radius_mm * focal_px / (end.z() - capsule.radius_mm) + kSlackPx;
    box.x0 = std::min(box.x0, static_cast<int>(std::clamp(pixel->x() - reach_px, 0.0, 1e5)));
    box.y0 = std::min(box.y0, static_cast<int>(std::clamp(pixel->y() - reach_px, 0.0, 1e5)));
    box.x1 = std::max(box.x1, static_cast<int>(std::clamp(pixel->x() + reach_px, -1.0, 1e5)) + 1);
    box.y1 = std::max(box.y1, static_cast<int>(std::clamp(pixel->y() + reach_px, -1.0, 1e5)) + 1);
  }
  box.x1 = std::min(box.x1, camera.width_px()), box.y1 = std::min(box.y1, camera.height_px());
  return box;
}

// Smooth noise over the picture with the given standard deviation.
double NoiseAt(const MaskErrors& errors, int x, int y) {
  const double u = x / errors.noise_cell_px, v = y / errors.noise_cell_px;
  const double u0 = std::floor(u), v0 = std::floor(v);
  const auto node = [&](double du, double dv) {
    const auto number = static_cast<std::uint64_t>(u0 + du) * 65'536 + static_cast<std::uint64_t>(v0 + dv);
    return NormalFrom(errors.seed, number);
  };
  const double fu = u - u0, fv = v - v0;
  const double mixed = (1.0 - fv) * ((1.0 - fu) * node(0, 0) + fu * node(1, 0)) +
                       fv * ((1.0 - fu) * node(0, 1) + fu * node(1, 1));
  // Bilinear interpolation leaves (2 / 3)^2 of the variance, on average.
  return 1.5 * errors.noise_px * mixed;
}

}  // namespace

double NormalFrom(std::uint64_t seed, std::uint64_t number) {
  const std::uint64_t bits = Mix(Mix(seed) ^ number);
  const double u = (static_cast<double>(bits >> 32U) + 0.5) / 4294967296.0;
  const double v = static_cast<double>(bits & 0xffffffffU) / 4294967296.0;
  return std::sqrt(-2.0 * std::log(u)) * std::cos(2.0 * std::numbers::pi * v);
}

CapsuleCamera::CapsuleCamera(std::shared_ptr<const UndistortedPlane> plane) : plane_(std::move(plane)) {
  const core::CameraModel& camera = plane_->camera();
  std::vector<Eigen::Vector2d> pixels;
  for (int y = 0; y < camera.height_px(); ++y)
    for (int x = 0; x < camera.width_px(); ++x) pixels.emplace_back(x, y);
  std::vector<Eigen::Vector2d> positions(pixels.size());
  plane_->FromPixels(pixels, positions.data());
  ray_in_cam_.reserve(pixels.size());
  for (const Eigen::Vector2d& p : positions)
    ray_in_cam_.push_back(Vector3d(p.x(), p.y(), plane_->focal_px()).normalized());
}

core::SoftMask CapsuleCamera::MaskOf(std::span<const Solid> solids, const MaskErrors& errors) const {
  constexpr double kLevelsPerPx =
      110.0;  // less than 127 / 1 px: neighbours across the boundary aren't clipped
  constexpr float kFarOutside = -100.0F;
  const core::CameraModel& camera = plane_->camera();
  const int width = camera.width_px(), height = camera.height_px();
  std::vector<float> inside_px(ray_in_cam_.size(), kFarOutside);
  for (const Solid& solid : solids) {
    const CapsuleInCam capsule = CapsuleOf(solid, camera.cam_from_world());
    const PixelBox box = BoxAround(capsule, camera, plane_->focal_px());
    for (int y = box.y0; y < box.y1; ++y)
      for (int x = box.x0; x < box.x1; ++x) {
        const auto i =
            static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
        const auto here = static_cast<float>(InsidePx(capsule, ray_in_cam_[i], plane_->focal_px()));
        inside_px[i] = std::max(inside_px[i], here);
      }
  }
  constexpr float kNearPx = 4.0F;  // farther from the boundary errors change no label
  core::SoftMask soft{core::BitMask(width, height), {}};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      float& here = inside_px[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                              static_cast<std::size_t>(x)];
      if (here == kFarOutside) continue;
      here += static_cast<float>(errors.dilation_px);
      if (errors.noise_px > 0.0 && std::abs(here) < kNearPx)
        here += static_cast<float>(NoiseAt(errors, x, y));
      if (here >= 0.0F) soft.mask.Set(x, y, true);
    }
  const core::BitMask boundary = core::BoundaryPixels(soft.mask);
  for (int y = 0; y < height; ++y)
    for (std::size_t word = 0; word < boundary.words_per_row(); ++word) {
      std::uint64_t left = boundary.words()[static_cast<std::size_t>(y) * boundary.words_per_row() + word];
      for (; left != 0; left &= left - 1) {
        const std::size_t x = word * 64 + static_cast<std::size_t>(std::countr_zero(left));
        const double px = inside_px[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + x];
        const double level = std::round(127.5 + kLevelsPerPx * px);
        soft.levels.push_back(static_cast<std::uint8_t>(px >= 0.0 ? std::clamp(level, 128.0, 255.0)
                                                                  : std::clamp(level, 0.0, 127.0)));
      }
    }
  return soft;
}

}  // namespace elbowroom::recon::testing
