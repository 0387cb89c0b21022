// The operator's camera: it circles a target, and every move gives a new value.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "recon/appearance/scene_view.h"

namespace elbowroom::recon {

// The eye stands at target + distance * (cos el cos az, cos el sin az, sin el), world z up.
struct OrbitCamera {
  Eigen::Vector3d target_in_world = Eigen::Vector3d::Zero();
  double distance_mm = 1500.0;    // eye to target, kept within 10 mm to 100 m
  double azimuth_rad = -0.9;      // about world z, from world x
  double elevation_rad = 0.5;     // above the table's plane, within +-pi/2
  double vertical_fov_rad = 0.6;  // of the whole picture

  [[nodiscard]] bool operator==(const OrbitCamera&) const = default;
};

// What the camera sees; straight up and straight down are views like any other.
// Throws: PreconditionError: size not positive, field of view not within (0, pi).
[[nodiscard]] SceneView ViewFrom(const OrbitCamera& camera, int width_px, int height_px);

// The scene turns with the pointer: a drag over the whole height of the picture turns it by pi.
[[nodiscard]] OrbitCamera Orbited(const OrbitCamera& camera, const Eigen::Vector2d& drag_px, int height_px);

// Positive steps come nearer, by a tenth each.
[[nodiscard]] OrbitCamera Zoomed(const OrbitCamera& camera, double wheel_steps);

// Things at the target's depth stay under the pointer.
[[nodiscard]] OrbitCamera Panned(const OrbitCamera& camera, const Eigen::Vector2d& drag_px, int height_px);

// The same direction, aimed at the box's centre, and as near as possible with all of the box in the picture
// and a margin of 5 % a side.
// Throws: PreconditionError when the box is empty.
[[nodiscard]] OrbitCamera FittedTo(const OrbitCamera& camera, const Eigen::AlignedBox3d& box_in_world,
                                   int width_px, int height_px);

}  // namespace elbowroom::recon
