#include "recon/capture/picture_counter.h"

#include <cmath>

namespace elbowroom::recon {

using core::LossReason;

void PictureCounter::Lose(std::uint64_t count, LossReason reason) {
  if (count == 0) return;
  on_loss_({0, next_, next_ + count - 1, reason});
  next_ += count;
}

// Stamps jitter, so a new period counts for little.
void PictureCounter::FollowPeriod(std::uint64_t step, CaptureClock::time_point taken_at) {
  constexpr double kShare = 0.02;
  if (step != 1 || !last_at_) return;
  const double period_s = std::chrono::duration<double>(taken_at - *last_at_).count();
  if (period_s > 0.5 * period_s_ && period_s < 2.0 * period_s_) period_s_ += kShare * (period_s - period_s_);
}

std::uint64_t PictureCounter::Count(std::uint64_t device_number, CaptureClock::time_point taken_at) {
  if (has_begun_) {
    const std::uint64_t step = device_number - device_number_;
    FollowPeriod(step, taken_at);
    Lose(step - 1, LossReason::kNotSent);
  } else if (last_at_) {
    const double away_s = std::chrono::duration<double>(taken_at - *last_at_).count();
    const double periods = std::round(away_s / period_s_);
    Lose(periods > 1.0 ? static_cast<std::uint64_t>(periods) - 1 : 0, LossReason::kCameraGone);
  }
  has_begun_ = true;
  device_number_ = device_number;
  last_at_ = taken_at;
  return next_++;
}

void PictureCounter::CountLost(std::uint64_t device_number, CaptureClock::time_point taken_at,
                               LossReason reason) {
  const std::uint64_t number = Count(device_number, taken_at);
  on_loss_({0, number, number, reason});
}

}  // namespace elbowroom::recon
