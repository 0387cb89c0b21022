// A box of space.
#pragma once

#include <Eigen/Core>

namespace elbowroom::recon {

// The points center + half_edges * (a, b, c) with |a|, |b|, |c| <= 1: columns go from the centre to the
// middles of three faces, mm in world. Closed.
struct WorldBox {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  Eigen::Matrix3d half_edges = Eigen::Matrix3d::Zero();
};

}  // namespace elbowroom::recon
