// Tangents of moving hands as a rig with true poses, true clocks and noise would measure them, without
// pictures: hours of footage in minutes.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "core/rig.h"
#include "recon/consistency/epipolar_pairs.h"
#include "recon/consistency/tangencies.h"
#include "recon/consistency/tangency_response.h"
#include "tests/recon/consistency/moving_hands.h"

namespace elbowroom::recon::testing {

// Standard deviations. The first two are what tangencies_test finds with pictures: 0.17 px of residual, of
// which 0.05 px is the parabola's and so lasts as long as the hand's pose.
struct TangentErrors {
  std::uint64_t seed = 1;
  double noise_px = 0.16;        // new in each frame
  double slow_noise_px = 0.06;   // changes within a quarter of a second
  double lens_px = 0.05;         // what the lens model is off: smooth over the picture, the same all the time
  double calibration_px = 0.15;  // by which each camera's turn, and its shift, are off from the start
};

// From `from_s` on a camera stands otherwise.
struct Knock {
  core::CameraIndex camera = 0;
  double from_s = 0.0;
  PoseChange change = PoseChange::Zero();
};

class TangentFootage {
 public:
  TangentFootage(core::Rig rig, HandMotion motion, TangentErrors errors);

  std::vector<Knock> knocks;
  // Of a camera's silhouettes; by default none.
  std::function<double(core::CameraIndex, double time_s)> dilation_px;
  // By how much later than its stamp a picture was taken; by default not at all.
  std::function<double(core::CameraIndex, double stamp_s)> delay_s;

  [[nodiscard]] const std::shared_ptr<const EpipolarPairs>& pairs() const { return pairs_; }
  [[nodiscard]] const core::Rig& rig() const { return rig_; }

  [[nodiscard]] CameraTangents TangentsOf(core::CameraIndex camera, double stamp_s) const;
  // All cameras have the same stamp.
  [[nodiscard]] FrameTangencies FrameAt(double stamp_s) const;

 private:
  [[nodiscard]] core::RigidTransform TrueCamFromWorld(core::CameraIndex camera, double time_s) const;
  [[nodiscard]] double ErrorPx(core::CameraIndex camera, const EpipolarPair& pair, std::size_t side,
                               const Eigen::Vector2d& position, const Eigen::Vector2d& outwards,
                               double time_s) const;

  core::Rig rig_;
  std::shared_ptr<const EpipolarPairs> pairs_;
  HandMotion motion_;
  TangentErrors errors_;
};

// A turn about `axis_in_cam` (any length), and a shift of the centre along `shift_in_world`, that together
// move the picture by `px`, root mean square over it (docs/consistency.md). Either may be zero.
[[nodiscard]] PoseChange ChangeOfSize(const EpipolarPairs& pairs, core::CameraIndex camera,
                                      const Eigen::Vector3d& axis_in_cam,
                                      const Eigen::Vector3d& shift_in_world, double px);

}  // namespace elbowroom::recon::testing
