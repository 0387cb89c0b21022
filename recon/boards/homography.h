// Homographies of a plane, by the direct linear transform.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <vector>

namespace elbowroom::recon {

struct PointPair {
  Eigen::Vector2d from;
  Eigen::Vector2d to;
};

// The homography that takes `from` to `to` with the least algebraic error, coordinates normalised (Hartley
// 1997). Nothing: fewer than four pairs, or points on a line.
[[nodiscard]] std::optional<Eigen::Matrix3d> FitHomography(const std::vector<PointPair>& pairs);

[[nodiscard]] inline Eigen::Vector2d Map(const Eigen::Matrix3d& to_from_from, const Eigen::Vector2d& x) {
  return (to_from_from * x.homogeneous()).hnormalized();
}

// The derivative of Map at x.
[[nodiscard]] Eigen::Matrix2d MapDerivative(const Eigen::Matrix3d& to_from_from, const Eigen::Vector2d& x);

}  // namespace elbowroom::recon
