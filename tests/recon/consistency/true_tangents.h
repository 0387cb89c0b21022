// Where the outermost epipolar planes of spheres and capsules are: exact, without pictures.
#pragma once

#include <array>
#include <span>

#include "core/soft_mask.h"
#include "recon/consistency/epipolar_pairs.h"
#include "recon/consistency/tangents.h"
#include "recon/synthetic/solids.h"

namespace elbowroom::recon::testing {

// A plane through a line touches a capsule where it touches one of its two end spheres, and a sphere at
// atan2(its centre) -+ asin(radius / distance from the line).
[[nodiscard]] std::array<double, kTangentSides> TrueAnglesRad(const EpipolarPair& pair,
                                                              const Eigen::Vector3d& center_a_in_world,
                                                              std::span<const Solid> solids);

// The slow oracle: each boundary point of the mask goes through the camera's lens by itself, and its plane's
// angle comes from the cross product of the pair's baseline and its sight. The least and the largest angle.
[[nodiscard]] std::array<double, kTangentSides> SlowAnglesRad(const core::CameraModel& camera,
                                                              const core::CameraModel& other,
                                                              const Eigen::Vector3d& zero_in_world,
                                                              const core::SoftMask& mask);

}  // namespace elbowroom::recon::testing
