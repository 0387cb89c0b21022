// One piece of long work away from the UI thread.
#pragma once

#include <functional>
#include <stop_token>
#include <string>
#include <thread>

#include "app/console/view/bridge.h"

namespace elbowroom::console {

// Starts in the constructor; the destructor asks it to stop and waits for it.
class BackgroundJob {
 public:
  using Work = std::function<void(const std::stop_token& stop)>;
  using OnDone = std::function<void(const std::string& error)>;  // "" when all went well; else the one line

  // `work` runs on a thread of its own and throws when it fails; `on_done` then runs on the bridge's thread.
  BackgroundJob(Bridge& bridge, Work work, OnDone on_done);

  void Cancel() { thread_.request_stop(); }  // asks; doesn't wait

 private:
  std::jthread thread_;
};

}  // namespace elbowroom::console
