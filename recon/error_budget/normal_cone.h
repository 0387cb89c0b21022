// A direction as a sum of the normals of surfaces that meet at a point.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

namespace elbowroom::recon {

struct ConeWeights {
  std::vector<double> weights;  // one a normal, 0 or more; at most three aren't 0
  double residual = 1.0;        // |direction - sum of weights * normals|
};

// The non-negative least squares of the sum of weights * normals against the direction: the point of the
// normals' cone that is nearest to it. All are unit vectors. Every set of up to three normals is tried.
[[nodiscard]] ConeWeights WeightsInCone(std::span<const Eigen::Vector3d> normals,
                                        const Eigen::Vector3d& direction);

}  // namespace elbowroom::recon
