// How large the operator's pictures may be to keep up with the trial.
#pragma once

#include <array>
#include <cstddef>

namespace elbowroom::console {

// Follows the machine: pictures shrink where they take too long to draw and grow again where there is time,
// in a few steps, so that the size doesn't change with every picture. Thread: one.
class PicturePace {
 public:
  static constexpr double kAimMs = 120.0;  // a picture this old still follows the hand

  // Of the side of the largest picture.
  [[nodiscard]] double scale() const { return kScales[step_]; }

  void Add(double drawing_ms);  // of the last picture, drawn at scale()

 private:
  static constexpr std::array<double, 4> kScales = {1.0, 0.8, 0.65, 0.5};

  std::size_t step_ = 0;
  int in_a_row_ = 0;  // pictures that asked for the same change: above zero smaller, below zero larger
};

}  // namespace elbowroom::console
