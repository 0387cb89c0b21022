#include "tests/app/sweep/killed_workers.h"
#include "tests/support/places.h"

#include <signal.h>  // NOLINT: kill

#include <algorithm>
#include <cctype>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

namespace elbowroom::tests {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

struct Worker {
  int process = 0;
  std::string command;
};

// A process's arguments, with a space between.
std::string CommandOf(const fs::path& process) {
  std::ifstream file(process / "cmdline");
  std::string command(100'000, '\0');
  file.read(command.data(), std::ssize(command));  // a process that has just ended gives nothing
  command.resize(static_cast<std::size_t>(file.gcount()));
  std::ranges::replace(command, '\0', ' ');
  return command;
}

std::vector<Worker> WorkersOf(const fs::path& out) {
  std::vector<Worker> workers;
  for (const auto& entry : fs::directory_iterator("/proc")) {
    const std::string name = entry.path().filename().string();
    if (!std::ranges::all_of(name, [](unsigned char c) { return std::isdigit(c) != 0; })) continue;
    std::string command = CommandOf(entry.path());
    if (command.starts_with(test_support::ProgramFile().string()) &&
        command.find("--cells-only") != std::string::npos && command.find(out.string()) != std::string::npos)
      workers.push_back({std::stoi(name), std::move(command)});
  }
  return workers;
}

bool IsOf(const Worker& worker, const fs::path& session) {
  return worker.command.find(session.string()) != std::string::npos;
}

// Those of sessions that still are in `delays` are killed once they are due; a session that was killed is
// taken out of it.
std::size_t KillThoseDue(const fs::path& out, FirstAttemptsKilled::Delays* delays,
                         std::map<int, Clock::time_point>* seen) {
  std::size_t kills = 0;
  for (const Worker& worker : WorkersOf(out)) {
    const Clock::time_point first = seen->try_emplace(worker.process, Clock::now()).first->second;
    std::erase_if(*delays, [&](const auto& of_session) {
      if (!IsOf(worker, of_session.first) || Clock::now() < first + of_session.second) return false;
      const bool is_killed = ::kill(worker.process, SIGKILL) == 0;
      kills += is_killed ? 1 : 0;
      return is_killed;
    });
  }
  return kills;
}

}  // namespace

void KillEachWorker(const fs::path& out, const fs::path& session) {
  for (const Worker& worker : WorkersOf(out))
    if (IsOf(worker, session)) ::kill(worker.process, SIGKILL);
}

FirstAttemptsKilled::FirstAttemptsKilled(fs::path out, Delays delays)
    : thread_([this, out = std::move(out), delays = std::move(delays)](const std::stop_token& stop) mutable {
        std::map<int, Clock::time_point> seen;
        while (!stop.stop_requested() && !delays.empty()) kills_ += KillThoseDue(out, &delays, &seen);
      }) {}

std::size_t FirstAttemptsKilled::Kills() {
  thread_.request_stop();
  thread_.join();
  return kills_;
}

}  // namespace elbowroom::tests
