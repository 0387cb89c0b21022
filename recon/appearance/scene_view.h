// From where, and how, a picture of the scene is taken: an ideal pinhole camera.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "core/camera_model.h"
#include "core/rigid_transform.h"

namespace elbowroom::recon {

// Pinhole without distortion; square pixels, pixel centres at integers, principal point at the centre of the
// picture; camera axes x right, y down, z forward. A point X, Y, Z in cam falls on the pixel
// focal_px * (X, Y) / Z + PrincipalPoint().
struct SceneView {
  core::RigidTransform cam_from_world;
  int width_px = 640;
  int height_px = 480;
  double focal_px = 600.0;
  double near_mm = 20.0;     // nothing nearer along z is drawn
  double far_mm = 20'000.0;  // nor farther

  // Throws: PreconditionError: size not positive or above 16384 px, focal length not positive,
  // near and far not 0 < near < far, a rotation that isn't one.
  void Validate() const;

  [[nodiscard]] Eigen::Vector2d PrincipalPoint() const {
    return {0.5 * (width_px - 1), 0.5 * (height_px - 1)};
  }

  // Pixel position, also outside the picture; nothing at or behind the camera plane.
  [[nodiscard]] std::optional<Eigen::Vector2d> Project(const Eigen::Vector3d& x_in_world) const;

  // The ray through `pixel`, scaled to z = 1: x_in_cam = depth_mm * RayInCam(pixel).
  [[nodiscard]] Eigen::Vector3d RayInCam(const Eigen::Vector2d& pixel) const;

  [[nodiscard]] Eigen::Vector3d EyeInWorld() const { return cam_from_world.Inverse().translation_mm; }

  [[nodiscard]] bool operator==(const SceneView&) const = default;
};

// The view as a camera model. It makes the same picture, but near and far cut nothing off.
[[nodiscard]] core::CameraModel CameraOf(const SceneView& view);

}  // namespace elbowroom::recon
