// How long the UI thread kept its events waiting.
#pragma once

#include <QElapsedTimer>
#include <QTimer>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace elbowroom::console {

// Measures from the beginning to the end of its life, on the thread that makes it, between ticks of a timer.
// Time that the thread was ready to run while other programs had the processor doesn't count: that is the
// machine's load, not the window's fault. Waiting for a lock, a thread or a file counts in full.
class StallWatch {
 public:
  StallWatch();

  [[nodiscard]] double longest_ms() const { return longest_ms_; }
  [[nodiscard]] int ticks() const { return ticks_; }

  // Keeps the wait of each tick, in ms, from now on; at most so many.
  void KeepWaits(std::size_t at_most);
  [[nodiscard]] std::vector<double> TakeWaits() { return std::move(waits_ms_); }

 private:
  void Tick();

  QTimer timer_;
  QElapsedTimer since_tick_;
  std::int64_t load_delay_ns_ = 0;  // of this thread, since it began
  double longest_ms_ = 0.0;
  int ticks_ = 0;
  std::size_t most_waits_ = 0;
  std::vector<double> waits_ms_;
};

}  // namespace elbowroom::console
