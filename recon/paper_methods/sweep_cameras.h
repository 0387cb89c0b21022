// A rig's cameras with their silhouettes as textures, for the paper's volume query.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "core/rig.h"
#include "core/rigid_transform.h"
#include "core/soft_mask.h"
#include "recon/paper_methods/coverage_texture.h"

namespace elbowroom::recon {

inline constexpr std::size_t kMostSweepCameras = 64;

struct SweepCamera {
  core::CameraModel model;
  core::RigidTransform cam_from_view;  // view: the frame that points are given in
  CoverageTexture coverage;
  BlockOccupancy occupancy;
};

// The lens in single precision, by name; zero where the model has none.
struct SweepLensCoefficients {
  bool is_fisheye = false;
  std::array<float, 6> radial{};      // k1..k6, or fisheye's k1..k4
  std::array<float, 2> tangential{};  // p1, p2
  std::array<float, 4> prism{};       // s1..s4
};

[[nodiscard]] SweepLensCoefficients LensCoefficientsOf(const core::CameraModel& camera);

// Whether rounding decides the camera's label at a position of its picture: the coverage there is within
// 4/256 and a few roundings of one half, or the position is at the picture's border.
[[nodiscard]] bool IsMatterOfRounding(const SweepCamera& camera, const Eigen::Vector2d& position_px);

// One for each camera of the rig, sorted by the size of the coverage texture, the smallest first. Throws:
// core::Error{kCamera} naming the camera when a mask's size isn't the camera's; Error{kRange} for more than
// 64 cameras; PreconditionError unless there is one mask a camera.
[[nodiscard]] std::vector<SweepCamera> MakeSweepCameras(const core::Rig& rig,
                                                        std::span<const core::SoftMask> masks,
                                                        const core::RigidTransform& world_from_view);

}  // namespace elbowroom::recon
