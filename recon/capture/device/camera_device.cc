#include "recon/capture/device/camera_device.h"

namespace elbowroom::recon {

// Linux's steady_clock is CLOCK_MONOTONIC.
std::int64_t MonotonicNs() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

}  // namespace elbowroom::recon
