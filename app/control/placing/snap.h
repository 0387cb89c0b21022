// A part moved so that one of its faces, or holes, meets that of another part.
#pragma once

#include <Eigen/Core>

#include "app/control/placing/drag.h"
#include "core/rigid_transform.h"

namespace elbowroom::control {

// A place on a face, with the normal that points out of the part, of unit length.
struct FacePlace {
  Eigen::Vector3d point_in_world = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal_in_world = Eigen::Vector3d::UnitZ();
};

// The pose after which the moving face lies in the fixed face's plane and looks the other way: the smallest
// turn that does it, about the moving place, then a shift along the normal. What is free stays: nothing is
// shifted along the plane, nor turned about the normal. Faces that look the same way are turned about an axis
// across both, that of the world that is most across first.
[[nodiscard]] core::RigidTransform FaceToFace(const core::RigidTransform& world_from_part,
                                              const FacePlace& moving, const FacePlace& fixed);

// The pose after which both axes are one line: the smallest turn that makes them parallel, whichever way they
// point, about the moving axis's point, then a shift across the axis. What is free stays: the place along the
// axis and the turn about it.
[[nodiscard]] core::RigidTransform AxisToAxis(const core::RigidTransform& world_from_part,
                                              const AxisLine& moving, const AxisLine& fixed);

}  // namespace elbowroom::control
