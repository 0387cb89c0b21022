// Seeded rigs at the ends of what numbers can do: the ground of numeric_stress_test.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <string_view>
#include <vector>

#include "core/camera_model.h"
#include "core/rig.h"
#include "core/soft_mask.h"
#include "tests/recon/scenes/random_scene.h"

namespace elbowroom::recon {

enum class StressKind {
  kRandom,         // around the workspace, some of them in it
  kParallel,       // all look the same way
  kCoincident,     // one place and direction, to the bit or 1e-12 to 1e-3 of the size beside it
  kLookingAway,    // one of them has the workspace behind it
  kLongFocal,      // 50,000 px
  kShortFocal,     // 50 px
  kTiny,           // a workspace of 1 mm
  kHuge,           // ... of 1 km
  kFarOrigin,      // 10 km from the world's origin
  kLooseRotation,  // as far from a rotation as CameraModel accepts
  kZeros,          // +-0 and denormals in camera matrices, distortion, poses, workspace
};
inline constexpr int kStressKinds = 11;
[[nodiscard]] std::string_view ToString(StressKind kind);

struct StressScene {
  std::shared_ptr<const core::Rig> rig;
  std::vector<core::SoftMask> masks;  // of balls in the workspace, now and then of nothing that makes sense
  double size_mm = 1.0;               // half a side of the workspace, about
  Eigen::Vector3d middle_in_world = Eigen::Vector3d::Zero();  // of the workspace
};

// Cameras of 96 x 72 px without a lens or with an ordinary one, 50 to 50,000 px of focal length; either
// policy. What the kind doesn't say is random.
[[nodiscard]] StressScene MakeStressScene(Random* random, StressKind kind);

// A small view: far off, near by, inside, a camera of the rig's own or beside one by 1e-300 to 1e-3 of the
// size, on a face of the workspace or 1e-300 mm beside it.
[[nodiscard]] core::CameraModel MakeStressView(Random* random, const StressScene& scene);

}  // namespace elbowroom::recon
