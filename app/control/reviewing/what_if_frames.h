// Single frames of a session under review, as they were recorded and at other gaps.
#pragma once

#include <cstddef>
#include <deque>
#include <memory>
#include <optional>
#include <utility>

#include "app/control/frame_judge.h"
#include "app/control/recorded_frame.h"
#include "app/control/replay/recorded_motion.h"
#include "app/control/reviewing/reviewed_session.h"
#include "app/control/reviewing/what_if.h"

namespace elbowroom::control {

// Keeps the hulls of the last few frames. Thread: one.
class WhatIfFrames {
 public:
  explicit WhatIfFrames(std::shared_ptr<const ReviewedSession> session);

  // `held_mm` empty: as it was recorded. Else judged with these gaps, as JudgeMotionAt judges it; of a layout
  // with parts that give way, these stand where the recorded push had moved them, which may differ from what
  // the whole motion gives. Throws: as JudgeMotionAt.
  [[nodiscard]] SharedFrameResult At(std::size_t position, const HeldGaps& held_mm);

 private:
  [[nodiscard]] SharedFrameResult Recorded(std::size_t position);
  [[nodiscard]] SharedFrameResult Judged(const SharedFrameResult& recorded, std::size_t position,
                                         const HeldGaps& held_mm);

  std::shared_ptr<const ReviewedSession> session_;
  FrameRebuilder rebuilder_;
  RecordedMotion motion_;
  std::optional<FrameJudge> judge_;                             // made when it is needed
  std::deque<std::pair<std::size_t, SharedFrameResult>> kept_;  // by position, the last used first
};

}  // namespace elbowroom::control
