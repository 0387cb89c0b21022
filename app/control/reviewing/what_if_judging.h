// Judges pieces of the recorded motion at other gaps.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "app/control/frame_result_pool.h"
#include "app/control/replay/frame_judge_pool.h"
#include "app/control/replay/recorded_motion.h"
#include "app/control/replay/replay_changes.h"
#include "app/control/reviewing/reviewed_session.h"

namespace elbowroom::control {

// How the recorded motion is read for a session under review. The session must outlive it.
[[nodiscard]] RecordedMotion MotionOf(const ReviewedSession& session);

// Frames that follow each other.
struct WhatIfPiece {
  struct Frame {
    MotionFrame recorded;  // without a hull where no part is moved
    std::shared_ptr<FrameResult> result;
  };
  std::vector<Frame> frames;
};

// Which parts stand elsewhere, a flag a part.
[[nodiscard]] std::vector<bool> PartsMoved(const std::vector<core::RigidTransform>& recorded,
                                           const std::vector<core::RigidTransform>& held);

// Layouts without parts that give way.
class WhatIfJudging {
 public:
  // Both must outlive it. Throws: what FrameJudge throws.
  WhatIfJudging(const ReviewedSession& session, const ReplayLayout& layout);

  // The frames at these positions, before they are judged. Thread: one at a time.
  [[nodiscard]] std::shared_ptr<WhatIfPiece> Read(std::size_t first, std::size_t end);

  // A part whose pose is the recorded one keeps the recorded answer; one that stays, while the hull stays,
  // that of the frame before. Thread: any.
  void Judge(WhatIfPiece* piece);

 private:
  const ReviewedSession& session_;
  const ReplayLayout& layout_;
  std::shared_ptr<const core::Layout> shared_layout_;
  const core::SpacingPoses poses_;
  RecordedMotion motion_;
  FrameResultPool results_;
  FrameJudgePool judges_;
};

}  // namespace elbowroom::control
