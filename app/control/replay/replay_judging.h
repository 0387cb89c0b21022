// Judges runs of frames, several at once.
#pragma once

#include <span>

#include "app/control/replay/frame_judge_pool.h"
#include "app/control/replay/replay_runs.h"
#include "review/part_review.h"

namespace elbowroom::control {

class ReplayJudging {
 public:
  // The layout must outlive it. Throws: what FrameJudge throws.
  ReplayJudging(const core::Layout& layout, const review::PartReviewOptions& review);

  [[nodiscard]] std::span<const core::TriangleTree> part_trees() const { return judges_.part_trees(); }

  // Finds contacts, recovery and clearance in all frames of the run. `last`: the judged frame before it, of a
  // run that goes on; else null. Thread: any.
  void Judge(const FrameResult* last, ReplayRun* run);

 private:
  FrameJudgePool judges_;
};

}  // namespace elbowroom::control
