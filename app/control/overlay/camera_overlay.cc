#include "app/control/overlay/camera_overlay.h"

#include <algorithm>
#include <array>
#include <utility>

#include "core/error.h"

namespace elbowroom::control {
namespace {

// Lines are brighter than faces, so that they show on them.
constexpr float kLineBrightness = 1.35F;

using Rgb = std::array<float, 3>;

Rgb ColorOf(const Eigen::Vector3f& color, float brightness) {
  Rgb rgb{};
  for (std::size_t c = 0; c < 3; ++c)
    rgb[c] = std::clamp(255.0F * brightness * color[static_cast<Eigen::Index>(c)], 0.0F, 255.0F);
  return rgb;
}

void Blend(const Rgb& color, float share, std::uint8_t* pixel) {
  for (std::size_t c = 0; c < 3; ++c) {
    const auto below = static_cast<float>(pixel[c]);
    pixel[c] = static_cast<std::uint8_t>(below + share * (color[c] - below) + 0.5F);
  }
}

}  // namespace

OverlayCount& OverlayCount::operator+=(const OverlayCount& other) {
  parts_drawn += other.parts_drawn;
  parts_kept += other.parts_kept;
  layers_composed += other.layers_composed;
  layers_kept += other.layers_kept;
  hulls_viewed += other.hulls_viewed;
  hulls_kept += other.hulls_kept;
  hulls_unasked += other.hulls_unasked;
  return *this;
}

CameraOverlay::CameraOverlay(const core::CameraModel& camera, int width_px, int height_px,
                             const OverlayLook& look)
    : look_(look), view_(ScaledTo(camera, width_px, height_px)) {
  core::Require(look.line_width_px > 0.0 && look.line_width_px <= 16.0,
                "an overlay's lines are wider than 0 px and at most 16");
  core::Require(look.face_opacity >= 0.0 && look.face_opacity <= 1.0,
                "an overlay's opacity is within [0, 1]");
  layer_ = ComposeLayer(view_, {}, look_.line_width_px);
}

void CameraOverlay::Place(std::span<const OverlayPart> parts) {
  bool is_kept = parts.size() == pictures_.size();
  pictures_.resize(parts.size());
  colors_.clear();
  for (std::size_t i = 0; i < parts.size(); ++i) {
    colors_.push_back(parts[i].color);
    const core::RigidTransform cam_from_part = view_.camera().cam_from_world() * parts[i].world_from_part;
    if (pictures_[i] && pictures_[i]->mesh == parts[i].mesh && pictures_[i]->cam_from_part == cam_from_part) {
      ++count_.parts_kept;
      continue;
    }
    ++count_.parts_drawn;
    is_kept = false;
    pictures_[i] = std::make_shared<const PartPicture>(
        PartPicture{parts[i].mesh, cam_from_part, DrawFaces(view_, parts[i].mesh->mesh(), cam_from_part),
                    DrawLines(view_, *parts[i].mesh, cam_from_part)});
  }
  ++(is_kept ? count_.layers_kept : count_.layers_composed);
  if (!is_kept) layer_ = ComposeLayer(view_, pictures_, look_.line_width_px);
}

void CameraOverlay::ViewHull(const std::shared_ptr<const recon::VisualHull>& hull) {
  if (hull_ == hull) {
    ++count_.hulls_kept;
    return;
  }
  hull_ = hull;
  ++count_.hulls_viewed;
  hull_view_ = recon::ViewHull(*hull, view_.rays(), {.surfaces = false, .normals = false},
                               std::exchange(hull_view_, {}));
}

void CameraOverlay::PaintOn(recon::Image* picture, const std::shared_ptr<const recon::VisualHull>& hull) {
  core::Require(picture->width_px == layer_.width_px && picture->height_px == layer_.height_px,
                "a picture under an overlay has its size");
  const recon::PixelBox& box = layer_.box;
  if (box.right <= box.x) {
    ++count_.hulls_unasked;
    return;
  }
  if (hull) ViewHull(hull);
  const auto is_hidden = [&](std::size_t at, float depth_mm) {
    const float real_mm = hull ? hull_view_.depth_mm[at] : 0.0F;
    return real_mm > 0.0F && real_mm < depth_mm;
  };
  for (int y = box.y; y < box.bottom; ++y) {
    for (int x = box.x; x < box.right; ++x) {
      const std::size_t at = layer_.At(x, y);
      std::uint8_t* pixel = &picture->rgb[3 * at];
      if (layer_.face_depth_mm[at] > 0.0F && !is_hidden(at, layer_.face_depth_mm[at])) {
        const float shade = static_cast<float>(layer_.face_shade[at]) / 255.0F;
        Blend(ColorOf(colors_[layer_.face_part[at]], shade), static_cast<float>(look_.face_opacity), pixel);
      }
      if (layer_.line_share[at] > 0 && !is_hidden(at, layer_.line_depth_mm[at])) {
        const float share = static_cast<float>(layer_.line_share[at]) / 255.0F;
        Blend(ColorOf(colors_[layer_.line_part[at]], kLineBrightness), share, pixel);
      }
    }
  }
}

}  // namespace elbowroom::control
