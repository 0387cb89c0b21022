// Watches a rig while people work: says when a camera was turned or moved, which one, and by how much.
#pragma once

#include <Eigen/Core>
#include <deque>
#include <memory>
#include <optional>
#include <vector>

#include "core/ids.h"
#include "recon/consistency/epipolar_pairs.h"
#include "recon/consistency/tangencies.h"
#include "recon/consistency/tangency_response.h"
#include "recon/consistency/watch_block.h"

namespace elbowroom::recon {

struct WatchOptions {
  double block_s = 1.0;                   // evidence is summed over this; > 0
  int learning_blocks = 30;               // with hands in view, before anything is judged; >= 2
  int longest_window = 32;                // blocks that a change is looked for in; a power of 2
  double calibration_sigma_px = 1.0;      // by which a camera's turn, or its shift, may be off; > 0
  double steady_sigma_px = 0.3;           // of a pair's steady residual, which is learned; > 0
  double wander_sigma_px = 0.02;          // by which that differs from place to place; > 0
  double typical_change_px = 0.7;         // what a knock may well be: larger ones need more evidence; > 0
  double hours_per_false_alarm = 1000.0;  // with hands in view; > 0
  double naming_odds = 100.0;             // of the named camera against any other; >= 1
  double naming_share = 0.25;  // ... and by which its statistic must be larger than any other; [0, 1)
  BlockUnknowns unknowns = {};

  // Throws: PreconditionError naming the field out of range.
  void Validate() const;
};

// A camera that stands otherwise than it was calibrated and learned.
struct CameraMoved {
  core::CameraIndex camera = 0;
  double since_s = 0.0;  // the earliest instant of the evidence against it
  PoseChange change;     // rad, mm: docs of PoseChange
  Eigen::Matrix<double, 6, 6> covariance;
  double shift_px = 0.0;  // root mean square over the picture, at the workspace's middle
  double shift_sigma_px = 0.0;
  double statistic = 0.0;  // what exceeded the threshold
};

// What the last block says.
struct WatchState {
  int blocks = 0;  // with evidence, so far
  bool is_learning = true;
  double noise_factor = 1.0;  // the residuals' real scatter over their sigma, serial correlation included
  double threshold = 0.0;     // of the statistic
  double largest_statistic = 0.0;  // of the last block's tests
  bool has_changed = false;        // some camera moved
  // The cameras that explain it best, in the order of how well: more than one if none can be named.
  std::vector<core::CameraIndex> suspects;
  std::optional<CameraMoved> moved;  // stays
};

// A sequential test of generalised likelihood ratios (Willsky & Jones 1976) over windows of 1, 2, 4 ...
// blocks that end now, one for each camera, against what all blocks before say (docs/consistency.md).
// Dilation of silhouettes and skew of cameras are unknowns of each block, so neither light nor fast hands
// raise it. Thread: one at a time.
class RigWatch {
 public:
  explicit RigWatch(std::shared_ptr<const EpipolarPairs> pairs, const WatchOptions& options = {});

  // Frames in the order of time. A frame without tangencies costs nothing and counts for nothing.
  void Add(double time_s, FrameTangencies frame);

  [[nodiscard]] const WatchState& state() const { return state_; }

  // Of the change of one camera's pose, by a window of the last `blocks`, as if no other camera had moved:
  // how well it could be told. The inverse is the bound on its covariance.
  [[nodiscard]] Eigen::Matrix<double, 6, 6> Information(core::CameraIndex camera, int blocks) const;

 private:
  struct Block {
    double begin_s = 0.0;
    Evidence evidence;
  };
  // What a window says of each camera, given all that was learned before it.
  struct WindowTest {
    Eigen::MatrixXd information;
    Eigen::VectorXd score;
  };

  void CloseBlock();
  void Learn(const Evidence& evidence);
  void FinishLearning();
  void UpdateNoise(const Evidence& evidence, const Eigen::VectorXd& learned);
  [[nodiscard]] Eigen::MatrixXd LearnedInformation() const;
  [[nodiscard]] WindowTest Test(const Evidence& window) const;
  [[nodiscard]] CameraMoved ChangeOf(core::CameraIndex camera, const WindowTest& test, double since_s) const;
  void Judge();

  std::shared_ptr<const EpipolarPairs> pairs_;
  WatchOptions options_;
  WatchLayout layout_;
  Eigen::VectorXd prior_;  // information, by entry of the state
  std::vector<Eigen::Matrix<double, 6, 6>> shift_squares_;
  std::vector<StampedTangencies> open_;
  std::deque<Block> recent_;  // at most longest_window
  Evidence learned_;
  double noise_squares_ = 0.0, noise_count_ = 0.0;
  WatchState state_;
};

// The value that a chi squared variable of six degrees of freedom exceeds with this probability.
[[nodiscard]] double ChiSquaredSix(double probability);

}  // namespace elbowroom::recon
