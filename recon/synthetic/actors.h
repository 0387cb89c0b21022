// What a person works with, built from analytic solids: a hand with its forearm, a pipe, tongs, a cable.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <span>

#include "recon/synthetic/solids.h"

namespace elbowroom::recon {

// Flexion of one finger's three joints, 0 = stretched, positive towards the palm.
struct FingerBend {
  double base_rad = 0.0;
  double middle_rad = 0.0;
  double tip_rad = 0.0;
};

// Where one bone of the thumb points: from the finger direction towards the thumb's side, then to the palm.
struct ThumbBone {
  double aside_rad = 0.0;
  double down_rad = 0.0;
};

struct HandShape {
  std::array<FingerBend, 4> fingers;  // index, middle, ring, little
  std::array<ThumbBone, 3> thumb;     // metacarpal, proximal, distal
};

[[nodiscard]] HandShape OpenHand();
[[nodiscard]] HandShape PipePinch();   // fingers on the far side of an upright pipe, thumb on the near one
[[nodiscard]] HandShape TongsPinch();  // thumb against the index finger, the rest curled
[[nodiscard]] HandShape CuppedHand();  // half of a bowl, thumb beside the index finger
[[nodiscard]] HandShape Blend(const HandShape& from, const HandShape& to, double share);

// Whose hand it is.
struct HandBuild {
  double size = 1.0;                              // of an adult hand of 190 mm; > 0
  double glove_mm = 0.0;                          // thicker all round by this
  std::optional<Eigen::Vector3d> glove_bgr = {};  // its colour; nothing: skin
};

// Wrist frame of the right hand: origin in the wrist, x along the stretched fingers, y to the thumb's side, z
// out of the back of the hand. An adult hand of 190 mm. The forearm is a capsule pair from the wrist to the
// elbow.
[[nodiscard]] SyntheticObject Hand(const core::RigidTransform& world_from_wrist, const HandShape& shape,
                                   const Eigen::Vector3d& elbow_in_world, const HandBuild& build = {});

// The left one, its mirror image: y of the wrist frame is to the little finger's side.
[[nodiscard]] SyntheticObject LeftHand(const core::RigidTransform& world_from_wrist, const HandShape& shape,
                                       const Eigen::Vector3d& elbow_in_world);

// The paper's pipe: 140 mm long, 40 mm across, open. Pipe frame: z along the axis, origin in its lower end.
inline constexpr double kPipeLengthMm = 140.0;
inline constexpr double kPipeRadiusMm = 20.0;
inline constexpr double kPipeWallMm = 2.0;
[[nodiscard]] SyntheticObject Pipe(const core::RigidTransform& world_from_pipe);

// Two arms from a hinge. Tongs frame: origin between the closed tips, z from the tips to the hinge, the arms
// open along y; opening_rad is the angle between the arms.
inline constexpr double kTongsLengthMm = 160.0;
[[nodiscard]] SyntheticObject Tongs(const core::RigidTransform& world_from_tongs, double opening_rad);

// A plug pointing down with its front face at `plug_front_in_world`, then a cable from the plug's back
// through the control points (a Catmull-Rom curve; at least one point).
inline constexpr double kPlugLengthMm = 24.0;
inline constexpr double kPlugRadiusMm = 8.0;
inline constexpr double kCableRadiusMm = 3.5;
[[nodiscard]] SyntheticObject Cable(const Eigen::Vector3d& plug_front_in_world,
                                    std::span<const Eigen::Vector3d> through_in_world);

}  // namespace elbowroom::recon
