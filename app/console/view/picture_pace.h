// How fine the operator's pictures may be to keep up with the trial.
#pragma once

#include <array>
#include <cstddef>

namespace elbowroom::console {

// A picture's side and the hull's resolution in it, as shares of the finest.
struct PictureFineness {
  double picture = 1.0;
  double hull = 1.0;
  bool is_smooth = true;       // four samples a pixel, not one
  double relative_cost = 1.0;  // of drawing, roughly

  [[nodiscard]] bool operator==(const PictureFineness&) const = default;
};

// Follows the machine: pictures become coarser where they take too long to draw and finer again where there
// is time, in a few steps and with patience, so that they don't change to and fro. Thread: one.
class PicturePace {
 public:
  // Less than the time of a frame at 30 Hz, so that each frame is drawn although some pictures take longer.
  static constexpr double kAimMs = 30.0;
  static constexpr PictureFineness kFinest{};

  [[nodiscard]] const PictureFineness& fineness() const { return kSteps[step_]; }

  void Add(double drawing_ms);  // of a picture drawn with fineness()

 private:
  // The costs are those of software OpenGL with the demo's parts while the eye is still; docs/performance.md,
  // "Live cameras".
  static constexpr std::array<PictureFineness, 5> kSteps = {{{1.0, 1.0, true, 1.0},
                                                             {1.0, 1.0, false, 0.25},
                                                             {0.8, 0.5, false, 0.18},
                                                             {0.65, 0.5, false, 0.13},
                                                             {0.5, 0.5, false, 0.1}}};

  static constexpr std::size_t kFirstStep = 1;  // one sample a pixel: soon there is something to see

  std::size_t step_ = kFirstStep;
  int in_a_row_ = 0;  // pictures that asked for the same change: above zero coarser, below zero finer
};

}  // namespace elbowroom::console
