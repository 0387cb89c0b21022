// What about a second of tangencies says of the cameras' poses.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "recon/consistency/epipolar_pairs.h"
#include "recon/consistency/tangencies.h"

namespace elbowroom::recon {

// The state of a rig: six numbers a camera (PoseChange: how its true pose differs from the calibration), then
// a steady residual in px for each pair and side.
class WatchLayout {
 public:
  WatchLayout(std::size_t cameras, std::size_t pairs) : cameras_(cameras), pairs_(pairs) {}

  [[nodiscard]] Eigen::Index Pose(core::CameraIndex camera) const {
    return static_cast<Eigen::Index>(6 * camera);
  }
  [[nodiscard]] Eigen::Index Steady(std::size_t pair, TangentSide side) const {
    return static_cast<Eigen::Index>(6 * cameras_ + kTangentSides * pair + static_cast<std::size_t>(side));
  }
  [[nodiscard]] Eigen::Index steady_begin() const { return static_cast<Eigen::Index>(6 * cameras_); }
  [[nodiscard]] Eigen::Index size() const {
    return static_cast<Eigen::Index>(6 * cameras_ + kTangentSides * pairs_);
  }
  [[nodiscard]] std::size_t cameras() const { return cameras_; }

 private:
  std::size_t cameras_, pairs_;
};

// Sums of normal equations: information * state = score, without the block's own unknowns.
struct Evidence {
  Eigen::MatrixXd information;
  Eigen::VectorXd score;
  int residuals = 0;

  static Evidence None(const WatchLayout& layout);
  Evidence& operator+=(const Evidence& other);
};

// What differs from block to block, and so tells nothing of poses. Standard deviations.
struct BlockUnknowns {
  double dilation_px = 1.0;       // of one camera's silhouettes, by light and threshold; > 0
  double place_px = 0.05;         // by which a pair's residual differs with where the hands are; > 0
  double skew_s = 0.01;           // by which a camera is late, steadily; > 0
  double stamp_jitter_s = 0.001;  // by which it is late in one frame and not in the next; >= 0
};

struct StampedTangencies {
  double time_s = 0.0;
  FrameTangencies frame;
};

// The frames of a block, in the order of time. A tangency far from the median of its pair and side in this
// block is left out: more than 5 sigmas, 1 px, and what a skew of three `skew_s` does. So is one whose rate
// isn't known, since the frames beside it have none.
[[nodiscard]] Evidence EvidenceOf(const EpipolarPairs& pairs, const WatchLayout& layout,
                                  std::span<const StampedTangencies> frames, const BlockUnknowns& unknowns);

}  // namespace elbowroom::recon
