// From a point in a camera's frame to its pixel, with the derivatives by the point and by the lens.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "core/camera_model.h"

namespace elbowroom::recon {

inline constexpr int kMostIntrinsics = 18;  // fx fy cx cy and 14 of distortion

// A lens and camera matrix as numbers that a fit changes.
struct LensParameters {
  core::DistortionModel model = core::DistortionModel::kPlumbBob;
  double skew_px = 0.0;    // camera_matrix(0, 1); never changed
  Eigen::VectorXd values;  // fx fy cx cy, then the distortion as in core::CameraCalibration

  [[nodiscard]] int count() const { return static_cast<int>(values.size()); }
};

// The same camera matrix with another model: a plumb_bob as a rational lens is its polynomial over 1; else
// there is no distortion.
[[nodiscard]] LensParameters WithModel(const LensParameters& lens, core::DistortionModel model);

[[nodiscard]] LensParameters LensParametersOf(const core::CameraCalibration& calibration);
// Writes camera matrix, model and distortion.
void PutLens(const LensParameters& lens, core::CameraCalibration* calibration);

// As core::CameraModel::ProjectInCam to 1e-9 px (lens_projection_test), but also beyond the lens's domain.
// Nothing: the point isn't before the camera plane, or the denominator of a rational lens isn't above 0.05.
[[nodiscard]] std::optional<Eigen::Vector2d> ProjectPoint(const LensParameters& lens,
                                                          const Eigen::Vector3d& x_in_cam);

struct PosedPixel {
  Eigen::Vector2d pixel;
  Eigen::Matrix<double, 2, 3> by_x_in_cam;  // px / mm
};
// The same pixel with its derivative by the point, which is all that a pose needs.
[[nodiscard]] std::optional<PosedPixel> ProjectWithPointDerivative(const LensParameters& lens,
                                                                   const Eigen::Vector3d& x_in_cam);

struct ProjectedPoint : PosedPixel {
  Eigen::Matrix<double, 2, Eigen::Dynamic, 0, 2, kMostIntrinsics> by_values;  // px / unit of each value
};
// With the derivatives by the lens too (lens_projection_test holds them to differences).
[[nodiscard]] std::optional<ProjectedPoint> ProjectWithDerivatives(const LensParameters& lens,
                                                                   const Eigen::Vector3d& x_in_cam);

// The normalised point (X/Z, Y/Z) that falls on the pixel, to 1e-9 px, by Newton's method; nothing where that
// doesn't find one, as beyond a lens's fold.
[[nodiscard]] std::optional<Eigen::Vector2d> NormalisedPoint(const LensParameters& lens,
                                                             const Eigen::Vector2d& pixel);

}  // namespace elbowroom::recon
