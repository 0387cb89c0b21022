// The processes that an engine has begun for a sweep, killed as a machine without memory would.
#pragma once

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <map>
#include <thread>

namespace elbowroom::tests {

// Kills each process that keeps cells of this session in `out`, if there is one now.
void KillEachWorker(const std::filesystem::path& out, const std::filesystem::path& session);

// While it lives, the first process of each of these sessions that keeps cells in `out` is killed (SIGKILL),
// so long after it was seen first.
class FirstAttemptsKilled {
 public:
  using Delays = std::map<std::filesystem::path, std::chrono::milliseconds>;
  FirstAttemptsKilled(std::filesystem::path out, Delays delays);

  // Ends it. How many were killed; one that ended before its delay was over isn't.
  [[nodiscard]] std::size_t Kills();

 private:
  std::size_t kills_ = 0;
  std::jthread thread_;
};

}  // namespace elbowroom::tests
