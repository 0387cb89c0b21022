// Frames of a session under review, as fast as a reviewer drags through them.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>

#include "app/control/frame_result.h"
#include "app/control/reviewing/latest_task.h"
#include "app/control/reviewing/what_if_frames.h"

namespace elbowroom::control {

struct ScrubbedFrame {
  std::size_t position = 0;
  HeldGaps held_mm;
  SharedFrameResult result;  // null: it failed
  std::string error;         // one line
  double time_ms = 0.0;      // that it took
};

// Frames are made on a thread of its own; one that waits is given up for a later one. Thread: any may ask.
class FrameScrubber {
 public:
  // Called on the scrubber's thread; must not throw.
  using OnFrame = std::function<void(const ScrubbedFrame&)>;

  FrameScrubber(std::shared_ptr<const ReviewedSession> session, OnFrame on_frame);

  void Ask(std::size_t position, HeldGaps held_mm);

 private:
  WhatIfFrames frames_;  // the thread's
  OnFrame on_frame_;
  LatestTask thread_;  // last: it uses the others
};

}  // namespace elbowroom::control
