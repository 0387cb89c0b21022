#include "recon/appearance/shaded_depth.h"

#include <tbb/parallel_for.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "core/error.h"

namespace elbowroom::recon {
namespace {

using Eigen::Vector3f;

constexpr int kSmoothPx = 4;
// Depths farther apart than this share of the depth belong to different surfaces.
constexpr float kSameSurface = 0.05F;
const Vector3f kHullColor(0.86F, 0.66F, 0.48F);
const Vector3f kTop(0.93F, 0.94F, 0.96F), kBottom(0.72F, 0.75F, 0.79F);

class Painter {
 public:
  Painter(const ViewRays& rays, const DepthMap& picture) : rays_(rays), picture_(picture) {}

  // Mean of the depths around, on the same surface.
  [[nodiscard]] std::vector<float> Smoothed() const {
    std::vector<float> smooth(picture_.depth_mm.size());
    tbb::parallel_for(0, picture_.height_px, [&](int y) {
      for (int x = 0; x < picture_.width_px; ++x) smooth[Index(x, y)] = MeanAround(x, y);
    });
    return smooth;
  }

  // Towards the viewer, from differences of depths; straight at the viewer where there are no neighbours.
  [[nodiscard]] Vector3f NormalInView(std::span<const float> depth_mm, int x, int y) const {
    const Vector3f across = Difference(depth_mm, x, y, 1, 0), down = Difference(depth_mm, x, y, 0, 1);
    const Vector3f normal = down.cross(across);
    return normal.squaredNorm() > 0.0F ? Vector3f(normal.normalized()) : Vector3f(-Vector3f::UnitZ());
  }

  [[nodiscard]] static Vector3f Lit(const Vector3f& normal_in_view, const Vector3f& to_eye) {
    const Vector3f to_light = Vector3f(-0.45F, -0.75F, -0.85F).normalized();
    const Vector3f n = normal_in_view.dot(to_eye) < 0.0F ? Vector3f(-normal_in_view) : normal_in_view;
    const float key = std::max(n.dot(to_light), 0.0F), facing = std::max(n.dot(to_eye), 0.0F);
    const float highlight = std::pow(std::max(n.dot((to_light + to_eye).normalized()), 0.0F), 40.0F);
    const float sky = 0.5F - 0.5F * n.y();
    return kHullColor * (0.22F + 0.14F * sky + 0.5F * key + 0.2F * facing) +
           Vector3f::Constant(0.06F * highlight);
  }

  // Unit, against the pixel's ray.
  [[nodiscard]] Vector3f ToEye(int x, int y) const {
    if (rays_.projection() == Projection::kOrthographic) return -Vector3f::UnitZ();
    return -rays_.At(x, y).cast<float>().homogeneous().normalized();
  }

  [[nodiscard]] std::size_t Index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(picture_.width_px) +
           static_cast<std::size_t>(x);
  }

 private:
  [[nodiscard]] bool IsOnSurface(float depth_mm, float other_mm) const {
    return other_mm > 0.0F && std::abs(other_mm - depth_mm) <= kSameSurface * depth_mm;
  }

  [[nodiscard]] float MeanAround(int x, int y) const {
    const float depth_mm = picture_.depth_mm[Index(x, y)];
    if (depth_mm <= 0.0F) return 0.0F;
    float sum = 0.0F, count = 0.0F;
    for (int j = std::max(y - kSmoothPx, 0); j <= std::min(y + kSmoothPx, picture_.height_px - 1); ++j) {
      for (int i = std::max(x - kSmoothPx, 0); i <= std::min(x + kSmoothPx, picture_.width_px - 1); ++i) {
        const float other_mm = picture_.depth_mm[Index(i, j)];
        if (!IsOnSurface(depth_mm, other_mm)) continue;
        sum += other_mm;
        count += 1.0F;
      }
    }
    return sum / count;
  }

  [[nodiscard]] Vector3f Difference(std::span<const float> depth_mm, int x, int y, int dx, int dy) const {
    const float here_mm = depth_mm[Index(x, y)];
    const auto point = [&](int sign) -> Vector3f {
      const int i = std::clamp(x + sign * dx, 0, picture_.width_px - 1),
                j = std::clamp(y + sign * dy, 0, picture_.height_px - 1);
      const float other_mm = depth_mm[Index(i, j)];
      return IsOnSurface(here_mm, other_mm) ? PointInView(i, j, other_mm) : PointInView(x, y, here_mm);
    };
    return point(1) - point(-1);
  }

  [[nodiscard]] Vector3f PointInView(int x, int y, float depth_mm) const {
    const Eigen::Vector2f uv = rays_.At(x, y).cast<float>();
    if (rays_.projection() == Projection::kOrthographic) return {uv.x(), uv.y(), depth_mm};
    return depth_mm * uv.homogeneous();
  }

  const ViewRays& rays_;
  const DepthMap& picture_;
};

}  // namespace

Image ShadeDepth(const ViewRays& rays, const DepthMap& picture, std::span<const Vector3f> normal_in_world) {
  const std::size_t pixels = picture.depth_mm.size();
  core::Require(picture.width_px == rays.width_px() && picture.height_px == rays.height_px(),
                "a picture has its view's size");
  core::Require(normal_in_world.empty() || normal_in_world.size() == pixels,
                "normals are one a pixel, or none");
  const Painter painter(rays, picture);
  const std::vector<float> smooth = normal_in_world.empty() ? painter.Smoothed() : std::vector<float>();
  const Eigen::Matrix3f view_from_world = rays.view_from_world().rotation.cast<float>();
  Image image{picture.width_px, picture.height_px, std::vector<std::uint8_t>(3 * pixels)};
  tbb::parallel_for(0, image.height_px, [&](int y) {
    const float share = (static_cast<float>(y) + 0.5F) / static_cast<float>(image.height_px);
    for (int x = 0; x < image.width_px; ++x) {
      const std::size_t pixel = painter.Index(x, y);
      Vector3f color = kTop + share * (kBottom - kTop);
      if (picture.depth_mm[pixel] != 0.0F) {  // negative behind an orthographic view's plane
        const Vector3f to_eye = painter.ToEye(x, y);
        const bool is_known = !normal_in_world.empty() && normal_in_world[pixel].squaredNorm() > 0.0F;
        Vector3f normal_in_view = to_eye;
        if (is_known) normal_in_view = view_from_world * normal_in_world[pixel];
        if (normal_in_world.empty()) normal_in_view = painter.NormalInView(smooth, x, y);
        color = Painter::Lit(normal_in_view, to_eye);
      }
      for (Eigen::Index i = 0; i < 3; ++i) {
        image.rgb[3 * pixel + static_cast<std::size_t>(i)] =
            static_cast<std::uint8_t>(std::lround(255.0F * std::clamp(color[i], 0.0F, 1.0F)));
      }
    }
  });
  return image;
}

}  // namespace elbowroom::recon
