// Lets long work report how far it has come. std::stop_token cancels it.
#pragma once

#include <cstdint>
#include <functional>
#include <stop_token>
#include <string>
#include <utility>

namespace elbowroom::core {

// Thread: the callback runs on the thread that reports. It must not block.
class Progress {
 public:
  using Callback = std::function<void(std::int64_t done, std::int64_t total, const std::string& what)>;

  Progress() = default;  // reports to nobody
  explicit Progress(Callback callback) : callback_(std::move(callback)) {}

  // total <= 0: not known.
  void Report(std::int64_t done, std::int64_t total, const std::string& what) const {
    if (callback_) callback_(done, total, what);
  }

 private:
  Callback callback_;
};

// Throws: Error{kCancelled} naming `what` if a stop was requested.
void ThrowIfStopped(const std::stop_token& stop, const std::string& what);

}  // namespace elbowroom::core
