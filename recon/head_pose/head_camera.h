// A camera on the participant's head, registered by hand: its picture laid over the virtual scene.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "core/camera_model.h"
#include "core/rigid_transform.h"

namespace elbowroom::recon {

// A pinhole with square pixels, its axis through the middle of the picture.
struct HeadCamera {
  core::RigidTransform head_from_camera;  // both with x to the right, y down, z forward
  double focal_px = 600.0;                // (0, 1e5]
  int width_px = 640;
  int height_px = 480;

  // Throws: PreconditionError: a size or a focal length out of range, or not a rotation.
  void Validate() const;
  [[nodiscard]] core::CameraModel ModelFor(const core::RigidTransform& world_from_head) const;
  [[nodiscard]] bool operator==(const HeadCamera&) const = default;
};

// The camera with its picture of another size, the same field of view from side to side.
[[nodiscard]] HeadCamera ResizedTo(const HeadCamera& camera, int width_px, int height_px);

// A point of the scene, and where the picture shows it.
struct SeenPoint {
  Eigen::Vector3d x_in_head = Eigen::Vector3d::Zero();
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
};

// Where the camera sees a point; NaN for one that isn't before it.
[[nodiscard]] Eigen::Vector2d PixelOf(const HeadCamera& camera, const Eigen::Vector3d& x_in_head);

struct HeadCameraFit {
  HeadCamera camera;
  std::vector<double> residuals_px;  // one a point
  double rms_px = 0.0;               // sqrt of the mean of their squares
  int fitted = 0;                    // how many numbers were: 2, 4, 6 or 7
};

// The camera with the least sum of squared residuals, from `start` on by Levenberg and Marquardt's method. As
// many numbers are fitted as the points hold: one point: the two turns of the axis; two: also the turn about
// it and the focal length; three: place and turns; four and more: place, turns and focal length. The rest
// stays. (With four or more points of one plane that faces the camera, distance and focal length can't be
// told apart; the fit then stays near the start.) Throws: Error{kRange}: no point, or one that isn't before
// the camera.
[[nodiscard]] HeadCameraFit FitHeadCamera(const HeadCamera& start, std::span<const SeenPoint> points);

// Steps by hand, in the camera's own axes: what is seen moves by that many pixels, or millimetres.
[[nodiscard]] HeadCamera Turned(const HeadCamera& camera, const Eigen::Vector2d& by_px);  // x right, y down
[[nodiscard]] HeadCamera Rolled(const HeadCamera& camera, double clockwise_rad);  // what is seen turns so
[[nodiscard]] HeadCamera Moved(const HeadCamera& camera, const Eigen::Vector3d& by_mm);  // the camera itself
[[nodiscard]] HeadCamera Scaled(const HeadCamera& camera, double by);                    // the focal length

}  // namespace elbowroom::recon
