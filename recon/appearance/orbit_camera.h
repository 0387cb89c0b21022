// The operator's camera: it circles a target, and every move gives a new value.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/camera_model.h"
#include "recon/appearance/scene_view.h"

namespace elbowroom::recon {

// The eye stands at target + distance * (cos el cos az, cos el sin az, sin el), world z up.
struct OrbitCamera {
  Eigen::Vector3d target_in_world = Eigen::Vector3d::Zero();
  double distance_mm = 1500.0;    // eye to target, kept within 10 mm to 100 m
  double azimuth_rad = -0.9;      // about world z, from world x
  double elevation_rad = 0.5;     // above the table's plane, within +-pi/2
  double vertical_fov_rad = 0.6;  // of the whole picture
  // Parallel: the eye stands kParallelFactor times as far away, with a lens as much longer. What is as far
  // away as the target keeps its size, and all else nearly has it, as on a drawing.
  bool is_parallel = false;

  [[nodiscard]] bool operator==(const OrbitCamera&) const = default;
};

// Rays then differ in direction by 0.15 degrees from one side of a picture of the usual field to the other,
// and a length that is a quarter of the distance nearer or farther than the target by a thousandth in size.
inline constexpr double kParallelFactor = 256.0;

// What the camera sees; straight up and straight down are views like any other.
// Throws: PreconditionError: size not positive, field of view not within (0, pi).
[[nodiscard]] SceneView ViewFrom(const OrbitCamera& camera, int width_px, int height_px);

enum class StandardView { kFront, kBack, kLeft, kRight, kTop, kBottom, kIsometric };

// The same target and distance, along an axis of the world: from the front is towards +y, from the right
// towards -x, from the top towards -z with +y up in the picture. Isometric: all three axes are equally long.
[[nodiscard]] OrbitCamera Along(const OrbitCamera& camera, StandardView view);

// From where a camera stands and along its axis, at a target as far away as `center_in_world`; the camera's
// roll is lost.
[[nodiscard]] OrbitCamera OrbitLike(const core::CameraModel& camera, const Eigen::Vector3d& center_in_world);

// What a camera of a rig sees, without its lens: the middle of its picture has the camera's own scale.
[[nodiscard]] SceneView ViewFrom(const core::CameraModel& camera, const Eigen::Vector3d& center_in_world,
                                 int width_px, int height_px);

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
