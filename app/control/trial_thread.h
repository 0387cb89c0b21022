// A trial on a thread of its own, for those who must not wait for it.
#pragma once

#include <atomic>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "app/control/trial_runner.h"

namespace elbowroom::control {

// Starts in the constructor; ends by itself, by Stop(), or with the object.
// Thread: any; the callbacks come on the trial's own thread and must not block.
class TrialThread {
 public:
  struct Ended {
    std::optional<TrialOutcome> outcome;  // nothing if it failed
    std::string error;                    // the one line of what went wrong, else empty
  };

  TrialThread(TrialSetup setup, TrialOptions options, std::function<void(const Ended&)> on_ended);
  ~TrialThread();
  TrialThread(const TrialThread&) = delete;
  TrialThread& operator=(const TrialThread&) = delete;

  [[nodiscard]] TrialControls& controls() { return controls_; }
  void Stop();  // asks; doesn't wait

 private:
  TrialControls controls_;
  std::jthread thread_;
};

}  // namespace elbowroom::control
