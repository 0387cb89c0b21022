#include "app/control/reviewing/latest_task.h"

#include <utility>

namespace elbowroom::control {

LatestTask::LatestTask() : thread_([this](const std::stop_token& end) { Run(end); }) {}

LatestTask::~LatestTask() {
  thread_.request_stop();
  Cancel();
}

void LatestTask::AfterThis(Task task) {
  {
    const std::lock_guard lock(mutex_);
    waiting_ = std::move(task);
  }
  changed_.notify_all();
}

void LatestTask::InsteadOfThis(Task task) {
  std::stop_source running;
  {
    const std::lock_guard lock(mutex_);
    waiting_ = std::move(task);
    running = running_;
  }
  running.request_stop();
  changed_.notify_all();
}

void LatestTask::Cancel() { InsteadOfThis({}); }

void LatestTask::Run(const std::stop_token& end) {
  std::unique_lock lock(mutex_);
  while (changed_.wait(lock, end, [this] { return static_cast<bool>(waiting_); }) && !end.stop_requested()) {
    const Task task = std::exchange(waiting_, {});
    running_ = std::stop_source();
    const std::stop_token stop = running_.get_token();
    lock.unlock();
    task(stop);
    lock.lock();
  }
}

}  // namespace elbowroom::control
