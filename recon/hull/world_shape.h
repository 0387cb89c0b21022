// A box or a triangle in space.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace elbowroom::recon {

// Convex and closed. Frame: world, mm.
struct WorldShape {
  enum class Kind { kBox, kTriangle };

  // The points center + half_edges * (x, y, z) with |x|, |y|, |z| <= 1.
  [[nodiscard]] static WorldShape Box(const Eigen::Vector3d& center, const Eigen::Matrix3d& half_edges) {
    return {Kind::kBox, center, half_edges};
  }
  [[nodiscard]] static WorldShape Triangle(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                           const Eigen::Vector3d& c) {
    WorldShape triangle{Kind::kTriangle, a, Eigen::Matrix3d::Zero()};
    triangle.edges.col(0) = b - a, triangle.edges.col(1) = c - a;
    return triangle;
  }

  Kind kind = Kind::kBox;
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  Eigen::Matrix3d edges = Eigen::Matrix3d::Zero();

  // Holds every point of it but for rounding.
  [[nodiscard]] Eigen::AlignedBox3d Bounds() const {
    if (kind == Kind::kTriangle) {
      const Eigen::Vector3d low = edges.rowwise().minCoeff().cwiseMin(0.0);
      const Eigen::Vector3d high = edges.rowwise().maxCoeff().cwiseMax(0.0);
      return {origin + low, origin + high};
    }
    const Eigen::Vector3d reach = edges.cwiseAbs().rowwise().sum();
    return {origin - reach, origin + reach};
  }
};

}  // namespace elbowroom::recon
