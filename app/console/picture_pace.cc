#include "app/console/picture_pace.h"

#include <algorithm>
#include <cstdlib>

namespace elbowroom::console {
namespace {

constexpr int kPatience = 2;         // one slow picture may be another program's fault
constexpr double kRoomToGrow = 0.8;  // the larger picture should then take at most this share of the aim

}  // namespace

void PicturePace::Add(double drawing_ms) {
  const bool is_last = step_ + 1 == kScales.size();
  const double growth = step_ == 0 ? 1.0 : kScales[step_ - 1] / kScales[step_];
  if (drawing_ms > kAimMs && !is_last) {
    in_a_row_ = std::max(in_a_row_, 0) + 1;
  } else if (step_ > 0 && drawing_ms * growth * growth < kRoomToGrow * kAimMs) {
    in_a_row_ = std::min(in_a_row_, 0) - 1;
  } else {
    in_a_row_ = 0;
  }
  if (std::abs(in_a_row_) < kPatience) return;
  step_ = in_a_row_ > 0 ? step_ + 1 : step_ - 1;
  in_a_row_ = 0;
}

}  // namespace elbowroom::console
