#include "recon/capture/device/device_clock.h"

#include <cstdlib>

namespace elbowroom::recon {

std::int64_t DeviceClock::OnComputersClock(std::int64_t device_ns, std::int64_t arrived_ns) {
  const std::int64_t offset_ns = arrived_ns - device_ns;
  if (!least_.empty() && std::abs(offset_ns - least_.back().offset_ns) > kJumpNs) least_.clear();
  while (!least_.empty() && least_.front().arrived_ns < arrived_ns - kWindowNs) least_.pop_front();
  while (!least_.empty() && least_.back().offset_ns >= offset_ns) least_.pop_back();
  least_.push_back({arrived_ns, offset_ns});
  return device_ns + least_.front().offset_ns;
}

}  // namespace elbowroom::recon
