#include "recon/gl/scene/scene.h"

#include <cstddef>

#include "core/error.h"

namespace elbowroom::recon::gl {
namespace {

std::size_t TexelsOf(const HullView& hull) {
  return static_cast<std::size_t>(hull.width_px) * static_cast<std::size_t>(hull.height_px);
}

void RequireWhole(const HullView& hull) {
  core::Require(hull.width_px > 0 && hull.height_px > 0, "a hull's picture has a positive size");
  core::Require(hull.depth_mm.size() == TexelsOf(hull), "a hull's picture has a depth for each texel");
  core::Require(hull.normal_in_world.empty() || hull.normal_in_world.size() == TexelsOf(hull),
                "a hull's picture has a normal for each texel, or none");
}

}  // namespace

std::optional<CameraFrustum> FrustumOf(const core::CameraModel& camera, double depth_mm) {
  const double right = camera.width_px() - 0.5;
  const double bottom = camera.height_px() - 0.5;
  const std::array<Eigen::Vector2d, 4> corners_px{Eigen::Vector2d(-0.5, -0.5), Eigen::Vector2d(right, -0.5),
                                                  Eigen::Vector2d(right, bottom),
                                                  Eigen::Vector2d(-0.5, bottom)};
  const core::RigidTransform world_from_cam = camera.cam_from_world().Inverse();
  CameraFrustum frustum{camera.center_in_world(), {}};
  for (std::size_t i = 0; i < corners_px.size(); ++i) {
    const std::optional<Eigen::Vector2d> normalised = camera.NormalisedFromPixel(corners_px[i]);
    if (!normalised) return std::nullopt;
    frustum.corners_in_world[i] =
        world_from_cam * Eigen::Vector3d(depth_mm * normalised->x(), depth_mm * normalised->y(), depth_mm);
  }
  return frustum;
}

void Scene::Validate() const {
  view.Validate();
  core::Require(table_grid_mm > 0.0, "a table's grid step is positive");
  for (const ScenePart& part : parts) {
    core::Require(part.mesh != nullptr, "a part to draw has a mesh");
    core::Require(part.opacity >= 0.0F && part.opacity <= 1.0F, "a part's opacity lies within [0, 1]");
  }
  lamp.Validate();
  if (hull != nullptr) {
    RequireWhole(*hull);
    core::Require(hull_camera_color.empty() || hull_camera_color.size() == TexelsOf(*hull),
                  "a hull's picture has a camera colour for each texel, or none");
  }
  if (hull_from_lamp == nullptr) return;
  RequireWhole(*hull_from_lamp);
  core::Require(hull_from_lamp->width_px == hull_from_lamp->height_px,
                "a hull's picture from the lamp is square");
}

}  // namespace elbowroom::recon::gl
