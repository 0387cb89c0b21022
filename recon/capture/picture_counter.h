// Numbers a camera's pictures without a gap, over all its interruptions.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "core/picture_loss.h"
#include "recon/capture/captured_picture.h"

namespace elbowroom::recon {

// Every number from the first picture's on is given to one picture or to one loss. Thread: one.
class PictureCounter {
 public:
  using OnLoss = std::function<void(core::PictureLoss)>;
  explicit PictureCounter(OnLoss on_loss) : on_loss_(std::move(on_loss)) {}

  // A camera starts counting anew after this. The pictures that it would have taken meanwhile are lost;
  // how many those are follows from its rate and from the time until the next picture.
  void Interrupt() { has_begun_ = false; }

  // The number of a picture that the camera counted as `device_number`; tells of those that are missing
  // before it.
  [[nodiscard]] std::uint64_t Count(std::uint64_t device_number, CaptureClock::time_point taken_at);

  // The same for a picture that came and can't be used: it is told of as lost.
  void CountLost(std::uint64_t device_number, CaptureClock::time_point taken_at, core::LossReason reason);

  // The time from one picture to the next, s: the median of the last ones, or as the rate says until then.
  [[nodiscard]] double period_s() const { return period_s_; }
  void SetRate(double rate_hz) { period_s_ = 1.0 / rate_hz; }

 private:
  void Lose(std::uint64_t count, core::LossReason reason);
  void FollowPeriod(std::uint64_t step, CaptureClock::time_point taken_at);

  OnLoss on_loss_;
  bool has_begun_ = false;           // since the last interruption
  std::uint64_t device_number_ = 0;  // of the last picture, as the camera counts
  std::uint64_t next_ = 0;           // the number that comes next
  std::optional<CaptureClock::time_point> last_at_;
  double period_s_ = 1.0 / 30.0;
};

}  // namespace elbowroom::recon
