#include "tests/recon/coverage/ball_rigs.h"

#include <Eigen/Geometry>
#include <optional>
#include <string>

namespace elbowroom::recon {

using Eigen::Vector3d;

core::Rig RigAt(std::span<const Vector3d> eyes_mm, double focal_px, const Eigen::AlignedBox3d& workspace_mm,
                core::UnseenPolicy unseen) {
  core::Rig rig;
  rig.name = "test";
  rig.workspace_mm = workspace_mm;
  rig.unseen = unseen;
  for (const Vector3d& eye : eyes_mm) {
    core::CameraCalibration camera;
    camera.name = "cam" + std::to_string(rig.cameras.size() + 1);
    camera.image_width_px = camera.image_height_px = 1000;
    camera.camera_matrix << focal_px, 0.0, 499.5, 0.0, focal_px, 499.5, 0.0, 0.0, 1.0;
    camera.distortion_coefficients = {0.0, 0.0, 0.0, 0.0};
    camera.cam_from_world = core::CamFromWorldLookingAt(eye, Vector3d::Zero());
    rig.cameras.emplace_back(camera);
  }
  return rig;
}

Eigen::AlignedBox3d Cube(double half_mm) {
  return {Vector3d::Constant(-half_mm), Vector3d::Constant(half_mm)};
}

std::vector<core::BitMask> MasksOfBall(const core::Rig& rig, const Vector3d& center_mm, double radius_mm) {
  std::vector<core::BitMask> masks;
  for (const core::CameraModel& camera : rig.cameras) {
    core::BitMask& mask = masks.emplace_back(camera.width_px(), camera.height_px());
    const Vector3d center_in_cam = camera.cam_from_world() * center_mm;
    for (int y = 0; y < mask.height_px(); ++y) {
      for (int x = 0; x < mask.width_px(); ++x) {
        const std::optional<Eigen::Vector2d> ray = camera.NormalisedFromPixel({x, y});
        if (!ray) continue;
        const Vector3d way = ray->homogeneous().normalized();
        const double along_mm = way.dot(center_in_cam);
        if (along_mm > 0.0 && (center_in_cam - along_mm * way).norm() <= radius_mm) mask.Set(x, y, true);
      }
    }
  }
  return masks;
}

}  // namespace elbowroom::recon
