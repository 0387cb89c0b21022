// How many frames a second a trial gets through.
#pragma once

#include <chrono>
#include <deque>
#include <optional>

#include "core/ids.h"

namespace elbowroom::console {

// Counts by frame numbers, so that frames that were judged but not shown count too. Thread: one.
class FrameRate {
 public:
  using Clock = std::chrono::steady_clock;

  void Add(core::FrameIndex frame, Clock::time_point at);
  void Clear() { recent_.clear(); }

  // Over the last two seconds; nothing until there are two frames some time apart.
  [[nodiscard]] std::optional<double> frames_per_s() const;

 private:
  struct Sample {
    core::FrameIndex frame = 0;
    Clock::time_point at;
  };
  std::deque<Sample> recent_;
};

}  // namespace elbowroom::console
