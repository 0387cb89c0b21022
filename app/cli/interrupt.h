// Ctrl-C as a stop token: the command ends in order, nothing is left half-written.
#pragma once

#include <atomic>
#include <stop_token>
#include <thread>

namespace elbowroom::cli {

// While it lives, SIGINT, SIGTERM and SIGHUP ask the token to stop; a second one ends the program at once.
// Make it before other threads: they inherit the blocked signals.
class InterruptWatch {
 public:
  InterruptWatch();
  ~InterruptWatch();
  InterruptWatch(const InterruptWatch&) = delete;
  InterruptWatch& operator=(const InterruptWatch&) = delete;

  [[nodiscard]] std::stop_token stop() const { return source_.get_token(); }

 private:
  std::stop_source source_;
  std::atomic<bool> is_over_ = false;
  std::thread thread_;
};

}  // namespace elbowroom::cli
