// Rigs of plain cameras in chosen places, and masks of a ball: the ground for tests of coverage.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "core/rig.h"
#include "core/soft_mask.h"
#include "tests/recon/scenes/random_scene.h"

namespace elbowroom::recon {

// Pinholes of 1000 x 1000 px that look at the origin, `focal_px` long.
[[nodiscard]] core::Rig RigAt(std::span<const Eigen::Vector3d> eyes_mm, double focal_px,
                              const Eigen::AlignedBox3d& workspace_mm,
                              core::UnseenPolicy unseen = core::UnseenPolicy::kOutside);

// A cube about the origin.
[[nodiscard]] Eigen::AlignedBox3d Cube(double half_mm);

// The pixels whose ray meets the ball, one mask a camera, with the boundary between pixels.
[[nodiscard]] std::vector<core::SoftMask> MasksOfBall(const core::Rig& rig, const Eigen::Vector3d& center_mm,
                                                      double radius_mm);

}  // namespace elbowroom::recon
