#include "tests/recon/coverage/ball_rigs.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
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

namespace {

// By how much the pixel's ray passes inside of the ball's surface, in mm; nothing: the lens has no ray there.
std::optional<double> InsideMm(const core::CameraModel& camera, const Vector3d& center_in_cam,
                               double radius_mm, int x, int y) {
  const std::optional<Eigen::Vector2d> ray = camera.NormalisedFromPixel({x, y});
  if (!ray) return std::nullopt;
  const Vector3d way = ray->homogeneous().normalized();
  const double along_mm = way.dot(center_in_cam);
  if (along_mm <= 0.0) return std::nullopt;
  return radius_mm - (center_in_cam - along_mm * way).norm();
}

// Pixels from `first` up to `end`, x and y, that hold the ball's image; all where the lens doesn't say.
struct Window {
  Eigen::Vector2i first;
  Eigen::Vector2i end;
};
Window WindowOf(const core::CameraModel& camera, const Vector3d& center_in_cam, double radius_mm) {
  const Eigen::Vector2i size(camera.width_px(), camera.height_px());
  const std::optional<Eigen::Vector2d> middle = camera.ProjectInCam(center_in_cam);
  if (!middle || center_in_cam.z() < 2.0 * radius_mm) return {Eigen::Vector2i::Zero(), size};
  // Twice what a pinhole would need.
  const double half_px = 2.0 * camera.calibration().camera_matrix.diagonal().head<2>().maxCoeff() *
                         radius_mm * center_in_cam.norm() /
                         ((center_in_cam.z() - radius_mm) * center_in_cam.z());
  return {(middle->array() - half_px).floor().cast<int>().max(0),
          (middle->array() + half_px).ceil().cast<int>().min(size.array())};
}

}  // namespace

std::vector<core::SoftMask> MasksOfBall(const core::Rig& rig, const Vector3d& center_mm, double radius_mm) {
  std::vector<core::SoftMask> masks;
  for (const core::CameraModel& camera : rig.cameras) {
    core::SoftMask& soft = masks.emplace_back();
    soft.mask = core::BitMask(camera.width_px(), camera.height_px());
    const Vector3d center_in_cam = camera.cam_from_world() * center_mm;
    const auto inside_mm = [&](int x, int y) { return InsideMm(camera, center_in_cam, radius_mm, x, y); };
    const Window window = WindowOf(camera, center_in_cam, radius_mm);
    for (int y = window.first.y(); y < window.end.y(); ++y)
      for (int x = window.first.x(); x < window.end.x(); ++x)
        soft.mask.Set(x, y, inside_mm(x, y).value_or(-1.0) >= 0.0);
    // Levels that are linear in the distance put the boundary where it is.
    const Eigen::Matrix3d& k = camera.calibration().camera_matrix;
    const double levels_per_mm = 80.0 * std::min(k(0, 0), k(1, 1)) / center_in_cam.norm();
    const core::BitMask boundary = core::BoundaryPixels(soft.mask);
    for (int y = 0; y < soft.mask.height_px(); ++y) {
      for (int x = 0; x < soft.mask.width_px(); ++x) {
        if (!boundary.At(x, y)) continue;
        const double level = 127.5 + levels_per_mm * inside_mm(x, y).value_or(-1e9);
        const bool is_object = soft.mask.At(x, y);
        soft.levels.push_back(static_cast<std::uint8_t>(
            std::lround(std::clamp(level, is_object ? 128.0 : 0.0, is_object ? 255.0 : 127.0))));
      }
    }
  }
  return masks;
}

}  // namespace elbowroom::recon
