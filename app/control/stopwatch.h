// How long the stages of a frame take.
#pragma once

#include <chrono>

namespace elbowroom::control {

class Stopwatch {
 public:
  // Since the last lap or the start.
  double LapMs() {
    const auto now = std::chrono::steady_clock::now();
    const double lap_ms = std::chrono::duration<double, std::milli>(now - last_).count();
    last_ = now;
    return lap_ms;
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

}  // namespace elbowroom::control
