#include "recon/appearance/hull_appearance.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "recon/appearance/smooth_step.h"

namespace elbowroom::recon {
namespace {

// A weight from which on a photo is trusted fully.
constexpr float kEnough = 0.08F;
// A camera's weight falls with this power of (1 + cosine) / 2, for the angle between its line of sight and
// the viewer's: to a tenth at 60 degrees.
constexpr float kViewerPower = 8.0F;

std::uint8_t Level(float value) {
  return static_cast<std::uint8_t>(std::clamp(std::lround(value), 0L, 255L));
}

// Averaged over the neighbours on the same surface: the normals of a picture come from the edges of
// silhouettes, and single ones are off. Zero where they are all unknown.
Eigen::Vector3d SmoothNormal(const HullView& picture, int x, int y) {
  constexpr int kReachPx = 2;
  constexpr float kSameSurface = 0.005F;  // of the depth
  const auto at = [&](int u, int v) { return static_cast<std::size_t>(v * picture.width_px + u); };
  const float depth_mm = picture.depth_mm[at(x, y)];
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  for (int v = std::max(y - kReachPx, 0); v <= std::min(y + kReachPx, picture.height_px - 1); ++v) {
    for (int u = std::max(x - kReachPx, 0); u <= std::min(x + kReachPx, picture.width_px - 1); ++u) {
      if (std::abs(picture.depth_mm[at(u, v)] - depth_mm) > kSameSurface * depth_mm) continue;
      sum += picture.normal_in_world[at(u, v)];
    }
  }
  return sum.cast<double>().normalized();
}

CameraColor ColorAt(const Eigen::Vector3d& x_in_world, const Eigen::Vector3d& normal_in_world,
                    const Eigen::Vector3f& to_eye_in_world,
                    std::span<const std::shared_ptr<const CameraTexture>> photos) {
  Eigen::Vector3f sum_bgr = Eigen::Vector3f::Zero();
  float sum = 0.0F, best = 0.0F;
  for (const auto& photo : photos) {
    const std::optional<TextureSample> look = photo->Sample(x_in_world, normal_in_world);
    if (!look) continue;
    const float beside = 0.5F + 0.5F * look->to_camera_in_world.dot(to_eye_in_world);
    const float weight = look->weight * (std::pow(beside, kViewerPower) + 1e-4F);
    sum_bgr += weight * look->color_bgr;
    sum += weight;
    best = std::max(best, look->weight);
  }
  if (sum <= 0.0F) return {};
  const Eigen::Vector3f bgr = sum_bgr / sum;
  return {Level(bgr.z()), Level(bgr.y()), Level(bgr.x()), Level(255.0F * SmoothStep(best / kEnough))};
}

}  // namespace

bool HasPixelColors(HullAppearance appearance) {
  switch (appearance) {
    case HullAppearance::kFlat:
    case HullAppearance::kByNormal:
      return false;
    case HullAppearance::kOneCamera:
    case HullAppearance::kRigCameras:
    case HullAppearance::kCoverage:
    case HullAppearance::kUncertainty:
      return true;
  }
  return false;
}

std::vector<CameraColor> ColorHull(const HullView& picture, const SceneView& view,
                                   std::span<const std::shared_ptr<const CameraTexture>> photos) {
  core::Require(picture.width_px == view.width_px && picture.height_px == view.height_px,
                "a hull's picture has its view's size");
  std::vector<CameraColor> colors(picture.depth_mm.size());
  const core::RigidTransform world_from_cam = view.cam_from_world.Inverse();
  tbb::parallel_for(0, view.height_px, [&](int y) {
    for (int x = 0; x < view.width_px; ++x) {
      const auto pixel = static_cast<std::size_t>(y * view.width_px + x);
      const double depth_mm = picture.depth_mm[pixel];
      if (depth_mm <= 0.0) continue;
      const Eigen::Vector3d normal = SmoothNormal(picture, x, y);
      if (normal.isZero()) continue;
      const Eigen::Vector3d x_in_world = world_from_cam * (depth_mm * view.RayInCam({x, y}));
      const Eigen::Vector3d to_eye = (world_from_cam.translation_mm - x_in_world).normalized();
      colors[pixel] = ColorAt(x_in_world, normal, to_eye.cast<float>(), photos);
    }
  });
  return colors;
}

}  // namespace elbowroom::recon
