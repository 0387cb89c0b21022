#include "recon/appearance/scene_view.h"

#include <cmath>

#include "core/error.h"

namespace elbowroom::recon {
namespace {

constexpr int kMaxSidePx = 16384;  // the largest texture that every OpenGL 3.3 driver in use takes

}  // namespace

void SceneView::Validate() const {
  core::Require(width_px > 0 && height_px > 0, "a view has a positive size");
  core::Require(width_px <= kMaxSidePx && height_px <= kMaxSidePx, "a view is at most 16384 px a side");
  core::Require(std::isfinite(focal_px) && focal_px > 0.0, "a view's focal length is positive");
  core::Require(near_mm > 0.0 && near_mm < far_mm && std::isfinite(far_mm), "a view has 0 < near < far");
  core::Require(core::IsRotation(cam_from_world.rotation), "a view's rotation is orthonormal");
}

std::optional<Eigen::Vector2d> SceneView::Project(const Eigen::Vector3d& x_in_world) const {
  const Eigen::Vector3d x_in_cam = cam_from_world * x_in_world;
  if (x_in_cam.z() <= 0.0) return std::nullopt;
  return Eigen::Vector2d(focal_px * x_in_cam.head<2>() / x_in_cam.z() + PrincipalPoint());
}

Eigen::Vector3d SceneView::RayInCam(const Eigen::Vector2d& pixel) const {
  const Eigen::Vector2d normalised = (pixel - PrincipalPoint()) / focal_px;
  return {normalised.x(), normalised.y(), 1.0};
}

core::CameraModel CameraOf(const SceneView& view) {
  core::CameraCalibration calibration;
  calibration.name = "view";
  calibration.image_width_px = view.width_px;
  calibration.image_height_px = view.height_px;
  calibration.camera_matrix << view.focal_px, 0.0, view.PrincipalPoint().x(), 0.0, view.focal_px,
      view.PrincipalPoint().y(), 0.0, 0.0, 1.0;
  calibration.cam_from_world = view.cam_from_world;
  return core::CameraModel(calibration);
}

}  // namespace elbowroom::recon
