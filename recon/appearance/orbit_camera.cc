#include "recon/appearance/orbit_camera.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.h"

namespace elbowroom::recon {
namespace {

constexpr double kMinDistanceMm = 10.0;
constexpr double kMaxDistanceMm = 100'000.0;
constexpr double kZoomPerStep = 0.9;
constexpr double kFitShare = 0.9;          // of the picture's half width and height: 5 % free a side
constexpr double kNearShare = 0.02;        // near plane, of the distance to the target
constexpr double kFarMarginMm = 20'000.0;  // beyond the target: a room

// Rows: camera x, y, z axes in world. Worked out from the angles, so that looking straight down has an up.
Eigen::Matrix3d RotationCamFromWorld(const OrbitCamera& camera) {
  const double sin_az = std::sin(camera.azimuth_rad), cos_az = std::cos(camera.azimuth_rad);
  const double sin_el = std::sin(camera.elevation_rad), cos_el = std::cos(camera.elevation_rad);
  Eigen::Matrix3d rotation;
  rotation << -sin_az, cos_az, 0.0,               //
      sin_el * cos_az, sin_el * sin_az, -cos_el,  //
      -cos_el * cos_az, -cos_el * sin_az, -sin_el;
  return rotation;
}

double FocalPx(const OrbitCamera& camera, int height_px) {
  return 0.5 * height_px / std::tan(0.5 * camera.vertical_fov_rad);
}

}  // namespace

SceneView ViewFrom(const OrbitCamera& camera, int width_px, int height_px) {
  core::Require(camera.vertical_fov_rad > 0.0 && camera.vertical_fov_rad < std::numbers::pi,
                "a field of view lies within (0, pi)");
  SceneView view;
  const double farther = camera.is_parallel ? kParallelFactor : 1.0, eye_mm = farther * camera.distance_mm;
  view.cam_from_world.rotation = RotationCamFromWorld(camera);
  view.cam_from_world.translation_mm =
      Eigen::Vector3d(0.0, 0.0, eye_mm) - view.cam_from_world.rotation * camera.target_in_world;
  view.width_px = width_px;
  view.height_px = height_px;
  view.focal_px = farther * FocalPx(camera, height_px);
  view.near_mm = kNearShare * camera.distance_mm;
  view.far_mm = eye_mm + kFarMarginMm;
  if (camera.is_parallel) view.near_mm = std::max(view.near_mm, eye_mm - camera.distance_mm - kFarMarginMm);
  view.Validate();
  return view;
}

OrbitCamera Along(const OrbitCamera& camera, StandardView view) {
  constexpr double kQuarter = 0.5 * std::numbers::pi;
  OrbitCamera turned = camera;
  const auto set = [&](double azimuth_rad, double elevation_rad) {
    turned.azimuth_rad = azimuth_rad;
    turned.elevation_rad = elevation_rad;
    return turned;
  };
  switch (view) {
    case StandardView::kFront:
      return set(-kQuarter, 0.0);
    case StandardView::kBack:
      return set(kQuarter, 0.0);
    case StandardView::kLeft:
      return set(std::numbers::pi, 0.0);
    case StandardView::kRight:
      return set(0.0, 0.0);
    case StandardView::kTop:
      return set(-kQuarter, kQuarter);
    case StandardView::kBottom:
      return set(-kQuarter, -kQuarter);
    case StandardView::kIsometric:
      return set(-0.5 * kQuarter, std::atan(std::numbers::sqrt2 / 2.0));
  }
  return turned;
}

OrbitCamera OrbitLike(const core::CameraModel& camera, const Eigen::Vector3d& center_in_world) {
  const Eigen::Vector3d forward = camera.cam_from_world().rotation.row(2);
  OrbitCamera like;
  like.distance_mm =
      std::clamp(forward.dot(center_in_world - camera.center_in_world()), kMinDistanceMm, kMaxDistanceMm);
  like.target_in_world = camera.center_in_world() + like.distance_mm * forward;
  like.azimuth_rad = std::atan2(-forward.y(), -forward.x());
  like.elevation_rad = std::asin(std::clamp(-forward.z(), -1.0, 1.0));
  return like;
}

SceneView ViewFrom(const core::CameraModel& camera, const Eigen::Vector3d& center_in_world, int width_px,
                   int height_px) {
  SceneView view;
  view.cam_from_world = camera.cam_from_world();
  view.width_px = width_px;
  view.height_px = height_px;
  const Eigen::Matrix3d& matrix = camera.calibration().camera_matrix;
  view.focal_px =
      std::min(matrix(0, 0) * width_px / camera.width_px(), matrix(1, 1) * height_px / camera.height_px());
  const double distance_mm = std::max(kMinDistanceMm, (center_in_world - camera.center_in_world()).norm());
  view.near_mm = kNearShare * distance_mm;
  view.far_mm = distance_mm + kFarMarginMm;
  view.Validate();
  return view;
}

OrbitCamera Orbited(const OrbitCamera& camera, const Eigen::Vector2d& drag_px, int height_px) {
  core::Require(height_px > 0, "a picture has a positive height");
  const double rad_per_px = std::numbers::pi / height_px;
  OrbitCamera moved = camera;
  moved.azimuth_rad = std::remainder(camera.azimuth_rad - drag_px.x() * rad_per_px, 2.0 * std::numbers::pi);
  moved.elevation_rad = std::clamp(camera.elevation_rad + drag_px.y() * rad_per_px, -0.5 * std::numbers::pi,
                                   0.5 * std::numbers::pi);
  return moved;
}

OrbitCamera Zoomed(const OrbitCamera& camera, double wheel_steps) {
  OrbitCamera moved = camera;
  moved.distance_mm =
      std::clamp(camera.distance_mm * std::pow(kZoomPerStep, wheel_steps), kMinDistanceMm, kMaxDistanceMm);
  return moved;
}

OrbitCamera Panned(const OrbitCamera& camera, const Eigen::Vector2d& drag_px, int height_px) {
  core::Require(height_px > 0, "a picture has a positive height");
  const double mm_per_px = camera.distance_mm / FocalPx(camera, height_px);
  const Eigen::Matrix3d rotation = RotationCamFromWorld(camera);
  OrbitCamera moved = camera;
  moved.target_in_world -=
      mm_per_px * (drag_px.x() * rotation.row(0) + drag_px.y() * rotation.row(1)).transpose();
  return moved;
}

OrbitCamera FittedTo(const OrbitCamera& camera, const Eigen::AlignedBox3d& box_in_world, int width_px,
                     int height_px) {
  core::Require(!box_in_world.isEmpty(), "a box to fit is not empty");
  core::Require(width_px > 0 && height_px > 0, "a picture has a positive size");
  OrbitCamera fitted = camera;
  fitted.target_in_world = box_in_world.center();
  const Eigen::Matrix3d rotation = RotationCamFromWorld(camera);
  const double focal_px = FocalPx(camera, height_px);
  const double reach_x = kFitShare * 0.5 * width_px / focal_px;
  const double reach_y = kFitShare * 0.5 * height_px / focal_px;
  double distance_mm = kMinDistanceMm;
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3d offset_in_cam =
        rotation *
        (box_in_world.corner(static_cast<Eigen::AlignedBox3d::CornerType>(corner)) - fitted.target_in_world);
    const double depth_needed_mm =
        std::max(std::abs(offset_in_cam.x()) / reach_x, std::abs(offset_in_cam.y()) / reach_y);
    distance_mm = std::max(distance_mm, depth_needed_mm - (camera.is_parallel ? 0.0 : offset_in_cam.z()));
  }
  fitted.distance_mm = std::min(distance_mm, kMaxDistanceMm);
  return fitted;
}

}  // namespace elbowroom::recon
