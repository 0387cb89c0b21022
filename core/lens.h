// The lens of one camera: OpenCV's distortion models in the normalised image plane, with certified bounds.
#pragma once

#include <Eigen/Core>

#include <optional>
#include <string>
#include <vector>

#include "core/camera_model.h"

namespace elbowroom::core {

// A closed interval that encloses every value of an expression.
struct Interval {
  double lower = 0.0;
  double upper = 0.0;
};

// x_distorted = x * R(r) / r + tangential(x) + prism(x), r = |x|, all in the normalised plane (X/Z, Y/Z).
class Lens {
 public:
  // tan(89.5 degrees). In the normalised plane, directions at 90 degrees to the axis are infinitely far away;
  // no lens's domain reaches beyond this radius.
  static constexpr double kLargestRadius = 114.6;

  // Coefficients smaller than this are set to 0. A lens that has only such coefficients moves each position
  // within kLargestRadius by less than 2^-54 of its radius, which is below rounding (camera_model_test). If
  // they stayed, products of denormals would make Undistort up to thirteen times slower.
  static constexpr double kLeastCoefficient = 1e-30;

  // Throws: Error{kCamera} naming `who`: a coefficient count that the model doesn't have, a value not finite,
  // a tilted sensor (14 coefficients with a tilt other than 0).
  Lens(DistortionModel model, const std::vector<double>& coefficients, const std::string& who);

  // No distortion at all. A fisheye always distorts.
  [[nodiscard]] bool is_ideal() const { return is_ideal_; }

  [[nodiscard]] Eigen::Vector2d Distort(const Eigen::Vector2d& normalised) const;

  // Inverse of Distort within radius max_radius; nothing if no point there falls on `distorted`.
  [[nodiscard]] std::optional<Eigen::Vector2d> Undistort(const Eigen::Vector2d& distorted,
                                                         double max_radius) const;

  // The same, to 1e-12, by Newton's method from a point near the result. Nothing also if it doesn't converge
  // well within the domain; the caller then asks Undistort.
  [[nodiscard]] std::optional<Eigen::Vector2d> UndistortNear(const Eigen::Vector2d& distorted,
                                                             const Eigen::Vector2d& start,
                                                             double max_radius) const;

  // R(r) at a radius, and intervals that enclose R'(r) and R(r)/r over [r0, r1].
  [[nodiscard]] double RadialImage(double radius) const;
  [[nodiscard]] Interval RadialSlope(double r0, double r1) const;
  [[nodiscard]] Interval RadialScale(double r0, double r1) const;

  // Upper bounds, over the disc of that radius, on the norm of the Jacobian of tangential + prism, and on the
  // length of tangential + prism.
  [[nodiscard]] double OffAxisSlope(double radius) const;
  [[nodiscard]] double OffAxisLength(double radius) const;

 private:
  [[nodiscard]] Interval RadialSlopeOf(double r0, double r1) const;
  [[nodiscard]] Interval RadialScaleOf(double r0, double r1) const;
  [[nodiscard]] double RadialSlopeAt(double radius) const;
  [[nodiscard]] double RadiusFromImage(double image_radius, double start, double max_radius) const;
  [[nodiscard]] Eigen::Vector2d OffAxis(const Eigen::Vector2d& x) const;
  [[nodiscard]] Eigen::Matrix2d Slope(const Eigen::Vector2d& x) const;  // Jacobian of Distort

  DistortionModel model_;
  double k_[6] = {0, 0, 0, 0, 0, 0};  // fisheye: the first four
  double p1_ = 0.0, p2_ = 0.0;
  double s_[4] = {0, 0, 0, 0};
  bool is_ideal_ = false;
  bool has_off_axis_ = false;
};

}  // namespace elbowroom::core
