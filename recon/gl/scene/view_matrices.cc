#include "recon/gl/scene/view_matrices.h"

namespace elbowroom::recon::gl {

ViewMatrices MatricesOf(const SceneView& view) {
  // Pixel u has its centre at u + 0.5 in the window and the principal point is (width - 1) / 2, so that the
  // offsets cancel: x_ndc = 2 f X / (width Z).
  const double range_mm = view.far_mm - view.near_mm;
  Eigen::Matrix4d clip_from_cam = Eigen::Matrix4d::Zero();
  clip_from_cam(0, 0) = 2.0 * view.focal_px / view.width_px;
  clip_from_cam(1, 1) = 2.0 * view.focal_px / view.height_px;
  clip_from_cam(2, 2) = (view.far_mm + view.near_mm) / range_mm;
  clip_from_cam(2, 3) = -2.0 * view.far_mm * view.near_mm / range_mm;
  clip_from_cam(3, 2) = 1.0;
  return {view, clip_from_cam.cast<float>(), ToMatrix4f(view.cam_from_world),
          view.cam_from_world.rotation.col(2).cast<float>()};
}

Eigen::Matrix4f ToMatrix4f(const core::RigidTransform& b_from_a) {
  Eigen::Matrix4f matrix = Eigen::Matrix4f::Identity();
  matrix.topLeftCorner<3, 3>() = b_from_a.rotation.cast<float>();
  matrix.topRightCorner<3, 1>() = b_from_a.translation_mm.cast<float>();
  return matrix;
}

float DepthMmOf(float depth_buffer_value, const SceneView& view) {
  const double range_mm = view.far_mm - view.near_mm;
  return static_cast<float>(view.far_mm * view.near_mm / (view.far_mm - depth_buffer_value * range_mm));
}

}  // namespace elbowroom::recon::gl
