// A thread that does only what was asked for last.
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <stop_token>
#include <thread>

namespace elbowroom::control {

// Tasks run one at a time. Thread: any may ask; no call waits, but for the destructor, which asks the task
// that runs to stop and waits for it.
class LatestTask {
 public:
  // Must not throw. `stop`: of this task.
  using Task = std::function<void(const std::stop_token& stop)>;

  LatestTask();
  ~LatestTask();
  LatestTask(const LatestTask&) = delete;
  LatestTask& operator=(const LatestTask&) = delete;

  // Takes the place of the task that waits, if one does. The one that runs goes on.
  void AfterThis(Task task);
  // The same, and asks the one that runs to stop.
  void InsteadOfThis(Task task);
  // Nothing waits, and the one that runs is asked to stop.
  void Cancel();

 private:
  void Run(const std::stop_token& end);

  std::mutex mutex_;  // guards the following
  std::condition_variable_any changed_;
  Task waiting_;
  std::stop_source running_;
  std::jthread thread_;  // last: it uses the others
};

}  // namespace elbowroom::control
