// What lies on one side of a plane.
#pragma once

#include <Eigen/Core>

namespace elbowroom::recon {

// All x with outward . x <= at_mm, the plane itself too.
struct HalfSpace {
  Eigen::Vector3d outward = Eigen::Vector3d::UnitX();  // of unit length
  double at_mm = 0.0;                                  // the plane's distance from the origin along it

  // How far outside; negative within.
  [[nodiscard]] double BeyondMm(const Eigen::Vector3d& x) const { return outward.dot(x) - at_mm; }
  [[nodiscard]] bool operator==(const HalfSpace& other) const {
    return outward == other.outward && at_mm == other.at_mm;
  }
};

}  // namespace elbowroom::recon
