#include "app/control/trial_thread.h"

#include <memory>

#include "core/error.h"

namespace elbowroom::control {

TrialThread::TrialThread(TrialSetup setup, TrialOptions options, std::function<void(const Ended&)> on_ended)
    : thread_([this, setup = std::move(setup), options = std::move(options),
               on_ended = std::move(on_ended)](const std::stop_token& stop) {
        Ended ended;
        try {
          ended.outcome = RunTrial(setup, options, controls_, stop);
        } catch (const std::exception& error) {  // the worker's outermost loop: nothing may escape a thread
          ended.error = error.what();
        }
        on_ended(ended);
      }) {}

TrialThread::~TrialThread() = default;  // the thread is asked to stop, and waited for

void TrialThread::Stop() { thread_.request_stop(); }

}  // namespace elbowroom::control
