#include "recon/appearance/camera_texture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "core/error.h"
#include "recon/appearance/smooth_step.h"
#include "recon/exact_view/hull_view.h"

namespace elbowroom::recon {
namespace {

// A photo's weight grows from 0 to full over this distance from a rim in its picture.
constexpr float kFeatherPx = 6.0F;
// A depth that changes by more footprints than this from pixel to pixel is a rim: surfaces as steep as that
// (76 degrees) are hardly seen.
constexpr double kSteepest = 4.0;
// In footprints of a pixel: a point up to this far behind the surface that its camera sees counts as on it,
// because the pixels of the silhouettes leave a relief on the hull. From kSteepest on it counts as hidden.
constexpr double kOnSurface = 1.0;
// Cosine between normal and line of sight below which a camera has no weight.
constexpr double kGrazing = 0.1;

// 255 where all eight neighbours are in the picture, on the hull and on the same surface; else 0. If a rim
// passes between the four pixels around a place, none of them is inside.
cv::Mat InsideOfSurfaces(const HullView& sight, double focal_px) {
  cv::Mat inside(sight.height_px, sight.width_px, CV_8UC1, cv::Scalar(0));
  const int width_px = sight.width_px;
  const std::array<int, 8> around{-width_px - 1, -width_px, -width_px + 1, -1, 1,
                                  width_px - 1,  width_px,  width_px + 1};
  for (int y = 1; y + 1 < sight.height_px; ++y) {
    const float* depth_mm = &sight.depth_mm[static_cast<std::size_t>(y * width_px)];
    for (int x = 1; x + 1 < width_px; ++x) {
      const float here_mm = depth_mm[x];
      if (here_mm <= 0.0F) continue;
      const auto jump_mm = static_cast<float>(kSteepest / focal_px) * here_mm;
      const bool is_inside = std::ranges::all_of(
          around, [&](int step) { return std::abs(depth_mm[x + step] - here_mm) <= jump_mm; });
      inside.at<std::uint8_t>(y, x) = is_inside ? 255 : 0;
    }
  }
  return inside;
}

// The four pixels around a position that is at least one pixel inside of the picture.
struct Corners {
  int x, y;
  float u, v;  // weights of the right and of the lower ones

  explicit Corners(const Eigen::Vector2d& place_px)
      : x(static_cast<int>(std::floor(place_px.x()))),
        y(static_cast<int>(std::floor(place_px.y()))),
        u(static_cast<float>(place_px.x() - x)),
        v(static_cast<float>(place_px.y() - y)) {}

  template <typename T>
  [[nodiscard]] T Blend(const T& a, const T& b, const T& c, const T& d) const {
    return (a * (1.0F - u) + b * u) * (1.0F - v) + (c * (1.0F - u) + d * u) * v;
  }
};

Eigen::Vector3f Bgr(const cv::Vec3b& pixel) {
  return {static_cast<float>(pixel[0]), static_cast<float>(pixel[1]), static_cast<float>(pixel[2])};
}

}  // namespace

CameraTexture::CameraTexture(const VisualHull& hull, core::CameraModel camera, cv::Mat image_bgr)
    : camera_(std::move(camera)),
      image_bgr_(std::move(image_bgr)),
      focal_px_(
          std::min(camera_.calibration().camera_matrix(0, 0), camera_.calibration().camera_matrix(1, 1))) {
  core::Require(image_bgr_.type() == CV_8UC3 && image_bgr_.cols == camera_.width_px() &&
                    image_bgr_.rows == camera_.height_px(),
                "a photo is 8-bit BGR of its camera's size");
  HullView sight = ViewHull(hull, camera_, {.surfaces = false, .normals = false});
  cv::distanceTransform(InsideOfSurfaces(sight, focal_px_), trust_, cv::DIST_L2, cv::DIST_MASK_5, CV_32F);
  trust_.forEach<float>([](float& value, const int*) { value = SmoothStep(value / kFeatherPx); });
  depth_mm_ = std::move(sight.depth_mm);
}

std::optional<TextureSample> CameraTexture::Sample(const Eigen::Vector3d& x_in_world,
                                                   const Eigen::Vector3d& normal_in_world) const {
  const Eigen::Vector3d to_camera = (camera_.center_in_world() - x_in_world).normalized();
  const double facing = normal_in_world.dot(to_camera);
  if (facing <= kGrazing) return std::nullopt;
  const Eigen::Vector3d x_in_cam = camera_.cam_from_world() * x_in_world;
  const std::optional<Eigen::Vector2d> place_px = camera_.ProjectInCam(x_in_cam);
  if (!place_px || !(place_px->x() >= 0.0 && place_px->y() >= 0.0 && place_px->x() < camera_.width_px() - 1 &&
                     place_px->y() < camera_.height_px() - 1)) {
    return std::nullopt;
  }
  const Corners at(*place_px);
  const float trust = at.Blend(trust_.at<float>(at.y, at.x), trust_.at<float>(at.y, at.x + 1),
                               trust_.at<float>(at.y + 1, at.x), trust_.at<float>(at.y + 1, at.x + 1));
  if (trust <= 0.0F) return std::nullopt;

  // Where there is trust all four corners are on one surface, and the point is on it or behind.
  const auto sight_mm = [&](int x, int y) {
    return depth_mm_[static_cast<std::size_t>(y * camera_.width_px() + x)];
  };
  const double surface_mm = at.Blend(sight_mm(at.x, at.y), sight_mm(at.x + 1, at.y), sight_mm(at.x, at.y + 1),
                                     sight_mm(at.x + 1, at.y + 1));
  const double behind = (x_in_cam.z() - surface_mm) * focal_px_ / x_in_cam.z();  // in footprints
  const float visible = SmoothStep(static_cast<float>((kSteepest - behind) / (kSteepest - kOnSurface)));
  if (visible <= 0.0F) return std::nullopt;

  TextureSample look;
  look.color_bgr = at.Blend(
      Bgr(image_bgr_.at<cv::Vec3b>(at.y, at.x)), Bgr(image_bgr_.at<cv::Vec3b>(at.y, at.x + 1)),
      Bgr(image_bgr_.at<cv::Vec3b>(at.y + 1, at.x)), Bgr(image_bgr_.at<cv::Vec3b>(at.y + 1, at.x + 1)));
  look.weight = trust * visible * static_cast<float>((facing - kGrazing) / (1.0 - kGrazing));
  look.to_camera_in_world = to_camera.cast<float>();
  return look;
}

}  // namespace elbowroom::recon
