#include "app/control/parallel_tasks.h"

#include <tbb/parallel_for.h>
#include <tbb/partitioner.h>
#include <tbb/task_arena.h>

#include <exception>
#include <mutex>

namespace elbowroom::control {

void RunTasks(std::size_t count, const std::string& what, const std::stop_token& stop,
              const std::function<void(std::size_t, const std::stop_token&)>& task) {
  std::stop_source all;
  const std::stop_callback pass_on(stop, [&] { all.request_stop(); });
  std::once_flag once;
  std::exception_ptr first;
  tbb::parallel_for(
      tbb::blocked_range<std::size_t>(0, count, 1),
      [&](const tbb::blocked_range<std::size_t>& range) {
        tbb::this_task_arena::isolate([&] {
          for (std::size_t i = range.begin(); i < range.end(); ++i) {
            try {
              core::ThrowIfStopped(all.get_token(), what);
              task(i, all.get_token());
            } catch (...) {
              std::call_once(once, [&] { first = std::current_exception(); });
              all.request_stop();
            }
          }
        });
      },
      tbb::simple_partitioner());
  if (first) std::rethrow_exception(first);
}

}  // namespace elbowroom::control
