#include "app/console/view/picture_pace.h"

#include <algorithm>
#include <cstdlib>

namespace elbowroom::console {
namespace {

constexpr int kPatience = 2;           // one slow picture may be another program's fault
constexpr double kRoomToRefine = 0.8;  // the finer picture should then take at most this share of the aim

}  // namespace

void PicturePace::Add(double drawing_ms) {
  const bool is_coarsest = step_ + 1 == kSteps.size();
  const double finer_ms =
      step_ == 0 ? drawing_ms : drawing_ms * kSteps[step_ - 1].relative_cost / kSteps[step_].relative_cost;
  if (drawing_ms > kAimMs && !is_coarsest) {
    in_a_row_ = std::max(in_a_row_, 0) + 1;
  } else if (step_ > 0 && finer_ms < kRoomToRefine * kAimMs) {
    in_a_row_ = std::min(in_a_row_, 0) - 1;
  } else {
    in_a_row_ = 0;
  }
  if (std::abs(in_a_row_) < kPatience) return;
  step_ = in_a_row_ > 0 ? step_ + 1 : step_ - 1;
  in_a_row_ = 0;
}

}  // namespace elbowroom::console
