#include "app/cli/interrupt.h"

#include <pthread.h>
#include <unistd.h>

#include <csignal>

namespace elbowroom::cli {
namespace {

constexpr int kExitOnSecondInterrupt = 130;

sigset_t Interrupts() {
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, SIGINT);
  sigaddset(&set, SIGTERM);
  sigaddset(&set, SIGHUP);  // the terminal was closed
  return set;
}

}  // namespace

InterruptWatch::InterruptWatch() {
  const sigset_t set = Interrupts();
  pthread_sigmask(SIG_BLOCK, &set, nullptr);
  thread_ = std::thread([this, set] {
    int signal = 0;
    while (sigwait(&set, &signal) == 0 && !is_over_) {
      if (source_.stop_requested()) _exit(kExitOnSecondInterrupt);
      source_.request_stop();
    }
  });
}

InterruptWatch::~InterruptWatch() {
  is_over_ = true;
  pthread_kill(thread_.native_handle(), SIGHUP);  // wakes the waiting thread, and only it
  thread_.join();
}

}  // namespace elbowroom::cli
