// How long a trial's frames took, in memory that doesn't grow with them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace elbowroom::control {

// Counts times by size: from 1 µs to 1000 s, in steps of 1 %. What is outside counts as the nearest of these.
class FrameTimeTally {
 public:
  void Add(double time_ms);

  // The time of the frame in the middle, of two the longer one, to 0.5 %. Nothing: no frame was added.
  [[nodiscard]] std::optional<double> MedianMs() const { return QuantileMs(0.5); }
  // The least time that more than this share of the frames don't exceed, likewise; `share` in [0, 1).
  [[nodiscard]] std::optional<double> QuantileMs(double share) const;

 private:
  static constexpr std::size_t kSteps = 2084;  // log(1e9) / log(1.01), and one

  std::array<std::int64_t, kSteps> frames_{};
  std::int64_t all_ = 0;
};

}  // namespace elbowroom::control
