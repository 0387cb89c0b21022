// The paper's way with lenses: a picture undistorted by a coarse grid of exact positions.
#pragma once

#include "core/camera_model.h"
#include "core/soft_mask.h"

namespace elbowroom::recon {

// What an ideal camera at the same place would have seen.
struct UndistortedMask {
  core::CameraModel camera;  // no distortion; the real one's view and focal length, but see below
  core::SoftMask mask;
};

// `grid` x `grid` places of the undistorted picture are projected into the real one with the lens. Positions
// between them are interpolated bilinearly, and so is the mask at these positions. Off by the grid's error
// and by the resampling (about a tenth of a pixel at corners of the boundary). Places that the real picture
// doesn't show are object if `exterior_is_object`. A picture that would be more than twice as wide or high is
// made coarser. Throws: PreconditionError for grid < 2.
[[nodiscard]] UndistortedMask Undistort(const core::CameraModel& camera, const core::SoftMask& mask, int grid,
                                        bool exterior_is_object);

}  // namespace elbowroom::recon
