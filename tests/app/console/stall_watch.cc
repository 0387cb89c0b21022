#include "tests/app/console/stall_watch.h"

#include <algorithm>
#include <fstream>

namespace elbowroom::console {
namespace {

constexpr int kTickMs = 5;

// Linux counts how long this thread was ready to run and did not; 0 where the kernel doesn't tell.
std::int64_t LoadDelayNs() {
  std::ifstream file("/proc/thread-self/schedstat");
  std::int64_t on_processor_ns = 0, delay_ns = 0;
  file >> on_processor_ns >> delay_ns;
  return file ? delay_ns : 0;
}

}  // namespace

StallWatch::StallWatch() {
  QObject::connect(&timer_, &QTimer::timeout, &timer_, [this] { Tick(); });
  timer_.start(kTickMs);
  load_delay_ns_ = LoadDelayNs();
  since_tick_.start();
}

void StallWatch::Tick() {
  const std::int64_t delay_ns = LoadDelayNs();
  const auto waited_ns = static_cast<double>(since_tick_.nsecsElapsed() - (delay_ns - load_delay_ns_));
  const double wait_ms = std::max(0.0, 1e-6 * waited_ns - kTickMs);
  longest_ms_ = std::max(longest_ms_, wait_ms);
  if (waits_ms_.size() < most_waits_) waits_ms_.push_back(wait_ms);
  ++ticks_;
  load_delay_ns_ = delay_ns;
  since_tick_.start();
}

void StallWatch::KeepWaits(std::size_t at_most) {
  most_waits_ = at_most;
  waits_ms_.assign(at_most, 0.0);  // so that its pages are there before anybody counts them
  waits_ms_.clear();
}

}  // namespace elbowroom::console
