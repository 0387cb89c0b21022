// A rig with one more camera, which doesn't exist yet.
#pragma once

#include <cstddef>

#include "core/rigid_transform.h"
#include "recon/coverage/rig_coverage.h"

namespace elbowroom::recon {

// The rig with a camera at that pose, with the lens of camera `like`. Its calibration is taken to be as good
// as that of the rig's median camera: it shares the others' common error, which is that of the world's frame,
// and has an error of its own as camera `like` has, scaled to the median of the cameras' own errors
// (docs/coverage.md). An exact rig stays exact. Throws: Error{kCamera} as core::CameraModel.
[[nodiscard]] CalibratedRig WithCamera(const CalibratedRig& rig, std::size_t like,
                                       const core::RigidTransform& cam_from_world);

}  // namespace elbowroom::recon
