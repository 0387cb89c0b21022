#include "tests/accuracy/peak_memory.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <system_error>
#include <thread>

#include "core/error.h"
#include "tests/support/resident_memory.h"

namespace elbowroom::accuracy {
namespace {

using test_support::PeakResidentBytes;

void Look(pid_t process, PeakMemory& peak) {
  peak.program_bytes = std::max(peak.program_bytes, PeakResidentBytes(process));
  std::ifstream children(fmt::format("/proc/{0}/task/{0}/children", process));
  for (pid_t child = 0; children >> child;)
    peak.child_bytes = std::max(peak.child_bytes, PeakResidentBytes(child));
}

pid_t Start(const std::filesystem::path& program, const std::vector<std::string>& arguments) {
  std::vector<char*> words = {const_cast<char*>(program.c_str())};
  for (const std::string& argument : arguments) words.push_back(const_cast<char*>(argument.c_str()));
  words.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  pid_t process = 0;
  const int error = ::posix_spawn(&process, program.c_str(), &actions, nullptr, words.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) throw std::system_error(error, std::generic_category(), program.string());
  return process;
}

}  // namespace

PeakMemory PeakMemoryOf(const std::filesystem::path& program, const std::vector<std::string>& arguments) {
  const pid_t process = Start(program, arguments);
  PeakMemory peak;
  int status = 0;
  while (::waitpid(process, &status, WNOHANG) == 0) {
    Look(process, peak);
    std::this_thread::sleep_for(std::chrono::microseconds(500));
  }
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return peak;
  throw core::Error(core::ErrorKind::kFile, fmt::format("{}: ended with an error", program.string()));
}

}  // namespace elbowroom::accuracy
