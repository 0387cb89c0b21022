// What FCL says of two meshes when it is asked as its manual has it.
#pragma once

#include <Eigen/Core>

#include "core/rigid_transform.h"
#include "core/triangle_mesh.h"

namespace elbowroom::review::testing {

struct FclAnswers {
  bool meets = false;        // fcl::collide
  double distance_mm = 0.0;  // fcl::distance, with nearest points
  Eigen::Vector3d on_a = Eigen::Vector3d::Zero();
  Eigen::Vector3d on_b = Eigen::Vector3d::Zero();
};

[[nodiscard]] FclAnswers AskFcl(const core::TriangleMesh& a, const core::RigidTransform& world_from_a,
                                const core::TriangleMesh& b, const core::RigidTransform& world_from_b);

}  // namespace elbowroom::review::testing
