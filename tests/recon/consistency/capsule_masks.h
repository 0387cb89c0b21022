// Soft masks of spheres and capsules, fast enough for minutes of footage.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/soft_mask.h"
#include "recon/contours/undistorted_plane.h"
#include "recon/synthetic/solids.h"

namespace elbowroom::recon::testing {

struct MaskErrors {
  double dilation_px = 0.0;    // the boundary moves outwards by this, all around
  double noise_px = 0.0;       // standard deviation of the boundary across itself
  double noise_cell_px = 2.0;  // the noise is white at nodes this far apart, and bilinear between
  std::uint64_t seed = 0;
};

// One camera that sees spheres and capsules. The level of a pixel tells how far its centre is from the exact
// boundary, so that the boundary by marching squares is exact to about 0.02 px (tangencies_test).
class CapsuleCamera {
 public:
  explicit CapsuleCamera(std::shared_ptr<const UndistortedPlane> plane);

  // Throws: PreconditionError for a solid of another shape.
  [[nodiscard]] core::SoftMask MaskOf(std::span<const Solid> solids, const MaskErrors& errors = {}) const;

 private:
  std::shared_ptr<const UndistortedPlane> plane_;
  std::vector<Eigen::Vector3d> ray_in_cam_;  // unit, by pixel, row by row
};

// A standard normal number: a function of the seed and the number alone.
[[nodiscard]] double NormalFrom(std::uint64_t seed, std::uint64_t number);

}  // namespace elbowroom::recon::testing
