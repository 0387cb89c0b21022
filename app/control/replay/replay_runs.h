// A session's frames as a replay judges them: runs of frames that share one hull.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <vector>

#include "app/control/frame_result.h"
#include "app/control/frame_result_pool.h"
#include "app/control/replay/replay_changes.h"
#include "app/control/replay/replay_segmentation.h"
#include "recon/contours/undistorted_plane.h"
#include "recon/error_budget/motion_history.h"
#include "sessions/session_reader.h"

namespace elbowroom::control {

struct ReplayedFrame {
  core::FrameRecord recorded;           // with new silhouettes where it was segmented again
  std::shared_ptr<FrameResult> result;  // its contacts are found by the judge
  SegmentingCount segmenting = {};
};

// How many frames before `first` are needed so that the motion of each camera's silhouette is known as it was
// in the trial.
[[nodiscard]] std::size_t FramesOfMotion(const sessions::SessionReader& session,
                                         std::span<const sessions::FrameSummary> frames, std::size_t first);

// Frames that follow each other, with one hull, which isn't that of the frame before.
struct ReplayRun {
  std::vector<ReplayedFrame> frames;
  // Its hull is that of the run before: a run of many frames is cut into pieces. It is judged after that one.
  bool goes_on = false;
};

// Reads frames from the session and makes their hulls, once for silhouettes that stay. Thread: one.
class ReplayRuns {
 public:
  // `frames`: those of the session, from which [first, end) is wanted. `segmentation`: null, or one that
  // gives the recorded silhouettes. All must outlive it.
  ReplayRuns(const sessions::SessionReader& session, std::span<const sessions::FrameSummary> frames,
             const ReplayLayout& layout, std::size_t first, std::size_t end, bool asks_clearance,
             ReplaySegmentation* segmentation, std::stop_token stop);

  // Nothing: there are no more. Runs may begin before the first frame that is wanted, with the frames since
  // the hull's last change.
  [[nodiscard]] std::optional<ReplayRun> Next();

 private:
  struct Loaded {
    core::FrameRecord record;
    SharedHull hull;
    std::shared_ptr<const recon::SkewErrors> skew_errors;
    SegmentingCount segmenting;
  };
  [[nodiscard]] std::size_t BeginOfRun(std::size_t first) const;
  [[nodiscard]] Loaded Load(std::size_t i);
  [[nodiscard]] ReplayedFrame FrameFrom(Loaded loaded);

  const sessions::SessionReader& session_;
  std::span<const sessions::FrameSummary> frames_;
  const ReplayLayout& layout_;
  std::shared_ptr<const core::Layout> shared_layout_;
  const core::SpacingPoses poses_;
  std::shared_ptr<const core::Rig> rig_;
  recon::UndistortedPlanes planes_;
  recon::MotionHistory motions_;
  FrameResultPool results_;
  std::size_t next_ = 0;
  std::size_t end_;
  bool asks_clearance_;
  ReplaySegmentation* segmentation_;
  std::stop_token stop_;
  SharedHull last_hull_;
  std::optional<Loaded> pending_;  // the first frame of the next run
  bool goes_on_ = false;
};

}  // namespace elbowroom::control
