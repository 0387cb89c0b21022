#include "app/control/cameras/timed_wait.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <cstdint>
#include <mutex>

namespace elbowroom::control {

void WaitSeconds(const std::optional<double>& seconds, const std::string& what,
                 const core::Progress& progress, const std::stop_token& stop,
                 const std::function<bool()>& is_done) {
  using WaitClock = std::chrono::steady_clock;
  constexpr std::chrono::milliseconds kBetweenReports{100};
  std::mutex mutex;
  std::condition_variable_any wakes;
  const WaitClock::time_point begin = WaitClock::now();
  const std::int64_t whole = seconds ? static_cast<std::int64_t>(std::ceil(*seconds)) : 0;
  while (!stop.stop_requested() && !is_done()) {
    const WaitClock::time_point now = WaitClock::now();
    const std::chrono::duration<double> gone = now - begin;
    if (seconds && gone.count() >= *seconds) return;
    progress.Report(static_cast<std::int64_t>(gone.count()), whole, what);
    WaitClock::time_point until = now + kBetweenReports;
    if (seconds) {
      const std::chrono::duration<double> left(*seconds - gone.count());
      until = std::min(until, now + std::chrono::ceil<WaitClock::duration>(left));
    }
    std::unique_lock lock(mutex);
    wakes.wait_until(lock, stop, until, [] { return false; });
  }
}

}  // namespace elbowroom::control
