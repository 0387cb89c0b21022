// Many tasks, several at once, and what they report together.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <stop_token>
#include <string>
#include <utility>

#include "core/progress.h"

namespace elbowroom::control {

// Runs task(i, token) for each i < count on the threads that there are. A task that waits for work of its own
// lets its thread begin no other task. The first failure stops the others, by their token, and is thrown.
// Throws: what a task throws; core::Error{kCancelled} naming `what` on a stop.
void RunTasks(std::size_t count, const std::string& what, const std::stop_token& stop,
              const std::function<void(std::size_t, const std::stop_token&)>& task);

// What several threads report, one at a time; who comes meanwhile leaves it out. Thread: any.
class SharedProgress {
 public:
  SharedProgress(const core::Progress& progress, std::int64_t total, std::string unit)
      : progress_(progress), total_(total), unit_(std::move(unit)) {}

  void Add(std::int64_t number) {
    const std::int64_t done = done_ += number;
    if (is_reporting_.test_and_set()) return;
    progress_.Report(done, total_, unit_);
    is_reporting_.clear();
  }

 private:
  const core::Progress& progress_;
  const std::int64_t total_;
  const std::string unit_;  // "frames"
  std::atomic<std::int64_t> done_ = 0;
  std::atomic_flag is_reporting_;
};

}  // namespace elbowroom::control
