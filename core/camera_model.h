// A calibrated camera: where a point in space falls in the image, and how far a small ball can spread there.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/rigid_transform.h"

namespace elbowroom::core {

class Lens;

enum class DistortionModel { kPlumbBob, kRationalPolynomial, kFisheye };

[[nodiscard]] std::optional<DistortionModel> ParseDistortionModel(std::string_view text);
[[nodiscard]] std::string_view ToString(DistortionModel model);

// One camera as RIG.yml gives it. OpenCV's conventions: x right, y down, z forward, pixel centres at
// integers; distortion k1 k2 p1 p2 [k3 [k4 k5 k6 [s1 s2 s3 s4]]], fisheye k1..k4.
struct CameraCalibration {
  std::string name;
  int image_width_px = 0;
  int image_height_px = 0;
  Eigen::Matrix3d camera_matrix = Eigen::Matrix3d::Identity();
  DistortionModel distortion_model = DistortionModel::kPlumbBob;
  std::vector<double> distortion_coefficients;
  RigidTransform cam_from_world;
};

// A validated calibration with the lens's domain worked out. Immutable.
//
// The domain is a disc of radius max_radius() in the normalised image plane (X/Z, Y/Z) that covers the image
// and in which the lens is one-to-one in radius: beyond it a strong lens's polynomial folds back into the
// picture, so a point outside it is not seen, whatever the polynomial says.
class CameraModel {
 public:
  // Throws: Error{kCamera} naming the camera: image size not positive or too large, camera matrix singular or
  // not upper triangular, rotation not orthonormal, a value not finite or beyond 1e9, an unsupported number
  // of coefficients, a lens that folds at its centre.
  explicit CameraModel(CameraCalibration calibration);

  [[nodiscard]] const CameraCalibration& calibration() const { return calibration_; }
  [[nodiscard]] const std::string& name() const { return calibration_.name; }
  [[nodiscard]] int width_px() const { return calibration_.image_width_px; }
  [[nodiscard]] int height_px() const { return calibration_.image_height_px; }
  // The calibration's transform, its rounded rotation replaced by the nearest exact one. The transpose is
  // then the inverse, so that projecting a point and casting a ray through its pixel agree.
  [[nodiscard]] const RigidTransform& cam_from_world() const { return cam_from_world_; }
  [[nodiscard]] const Eigen::Vector3d& center_in_world() const { return center_in_world_; }
  [[nodiscard]] double max_radius() const { return max_radius_; }

  // The camera is a pinhole: no fisheye, and no distortion coefficient reaches Lens::kLeastCoefficient.
  [[nodiscard]] bool is_ideal() const;

  // Pixel position, which may lie outside the image. Nothing: the point is behind the camera plane or outside
  // the domain.
  [[nodiscard]] std::optional<Eigen::Vector2d> Project(const Eigen::Vector3d& x_in_world) const {
    return ProjectInCam(cam_from_world_ * x_in_world);
  }
  [[nodiscard]] std::optional<Eigen::Vector2d> ProjectInCam(const Eigen::Vector3d& x_in_cam) const;

  // Pixel position of a normalised image point; the caller keeps |normalised| <= max_radius().
  [[nodiscard]] Eigen::Vector2d PixelFromNormalised(const Eigen::Vector2d& normalised) const;

  // Normalised image point that falls on `pixel`, to 1e-12; nothing where the lens's domain has none.
  [[nodiscard]] std::optional<Eigen::Vector2d> NormalisedFromPixel(const Eigen::Vector2d& pixel) const;
  // The same, faster, when a normalised point near the result is known.
  [[nodiscard]] std::optional<Eigen::Vector2d> NormalisedFromPixel(const Eigen::Vector2d& pixel,
                                                                   const Eigen::Vector2d& nearby) const;

  // Certified bound on |d pixel / d normalised| over the disc of that radius (clamped to the domain), in px:
  // two normalised points of the disc that are d apart fall at most PixelStretch(radius) * d pixels apart.
  [[nodiscard]] double PixelStretch(double radius) const;

 private:
  [[nodiscard]] Eigen::Vector2d DistortedFromPixel(const Eigen::Vector2d& pixel) const;

  CameraCalibration calibration_;
  RigidTransform cam_from_world_;
  Eigen::Vector3d center_in_world_ = Eigen::Vector3d::Zero();
  double max_radius_ = 0.0;
  std::vector<double> stretch_px_;  // running maximum over radius bins
  std::shared_ptr<const Lens> lens_;
};

}  // namespace elbowroom::core
