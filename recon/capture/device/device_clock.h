// A camera's own clock, put on the computer's.
#pragma once

#include <cstdint>
#include <deque>

namespace elbowroom::recon {

// A camera stamps its pictures by a clock with an unknown beginning and a rate that is off by up to 100 ppm.
// A picture arrives later than it was taken, by a time that varies upwards only: the way's least time, and
// queues. So the least difference (arrival - stamp) over the last kWindowNs is the clock's offset plus that
// least time, and the queues' jitter is gone. The rate's error enters with at most kWindowNs * 100 ppm =
// 0.2 ms (device_clock_test). Thread: one.
class DeviceClock {
 public:
  static constexpr std::int64_t kWindowNs = 2'000'000'000;
  // A clock that jumps by more than this was set anew.
  static constexpr std::int64_t kJumpNs = 1'000'000'000;

  // When the picture would have arrived on a way without queues, ns on the computer's clock; never later than
  // `arrived_ns`.
  [[nodiscard]] std::int64_t OnComputersClock(std::int64_t device_ns, std::int64_t arrived_ns);

 private:
  struct Sample {
    std::int64_t arrived_ns = 0;
    std::int64_t offset_ns = 0;
  };
  std::deque<Sample> least_;  // offsets grow from front to back: the front is the least
};

}  // namespace elbowroom::recon
