#include "app/console/view/background_job.h"

#include <exception>
#include <utility>

namespace elbowroom::console {

BackgroundJob::BackgroundJob(Bridge& bridge, Work work, OnDone on_done)
    : thread_([&bridge, work = std::move(work), on_done = std::move(on_done)](const std::stop_token& stop) {
        std::string error;
        try {
          work(stop);
        } catch (
            const std::exception& failure) {  // the worker's outermost frame: nothing may escape a thread
          error = failure.what();
        }
        bridge.Post([on_done, error] { on_done(error); });
      }) {}

}  // namespace elbowroom::console
