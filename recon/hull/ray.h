// A half-line in the world.
#pragma once

#include <Eigen/Core>

namespace elbowroom::recon {

struct Ray {
  Eigen::Vector3d origin_in_world = Eigen::Vector3d::Zero();
  Eigen::Vector3d direction_in_world = Eigen::Vector3d::UnitZ();  // unit
};

}  // namespace elbowroom::recon
