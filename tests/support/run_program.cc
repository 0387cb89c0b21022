#include "tests/support/run_program.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <stdexcept>
#include <system_error>
#include <thread>
#include <utility>

namespace elbowroom::test_support {
namespace {

using Clock = std::chrono::steady_clock;

// What an exec that failed makes the child exit with, as a shell does.
constexpr int kCouldNotStart = 127;

class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() { Close(); }
  Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  Descriptor& operator=(Descriptor&&) = delete;
  [[nodiscard]] int number() const { return number_; }
  void Close() {
    if (number_ >= 0) close(number_);
    number_ = -1;
  }

 private:
  int number_;
};

[[noreturn]] void ThrowErrno(const std::string& what) {
  throw std::system_error(errno, std::generic_category(), what);
}

std::pair<Descriptor, Descriptor> MakePipe() {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) ThrowErrno("pipe");
  return {Descriptor(ends[0]), Descriptor(ends[1])};
}

// In the child: only calls that are safe between fork and exec; all memory was made before.
[[noreturn]] void Become(const char* folder, char* const* argv, char* const* envp, int out, int err,
                         int failure) {
  setpgid(0, 0);
  const int nothing = open("/dev/null", O_RDONLY);
  dup2(nothing, STDIN_FILENO);
  dup2(out, STDOUT_FILENO);
  dup2(err, STDERR_FILENO);
  if (folder == nullptr || chdir(folder) == 0) execve(argv[0], argv, envp);
  const int reason = errno;
  [[maybe_unused]] const ssize_t written = write(failure, &reason, sizeof reason);
  _exit(kCouldNotStart);
}

std::vector<std::string> EnvironmentWith(const std::map<std::string, std::string>& settings) {
  std::vector<std::string> all;
  for (char** entry = environ; *entry != nullptr; ++entry) {
    const std::string text = *entry;
    if (!settings.contains(text.substr(0, text.find('=')))) all.push_back(text);
  }
  for (const auto& [name, value] : settings) all.push_back(name + "=" + value);
  return all;
}

std::vector<char*> PointersTo(std::vector<std::string>& texts) {
  std::vector<char*> pointers;
  pointers.reserve(texts.size() + 1);
  for (std::string& text : texts) pointers.push_back(text.data());
  pointers.push_back(nullptr);
  return pointers;
}

// Reads both pipes until the child closed them; false when the deadline passes first.
bool ReadBoth(const Descriptor& out, const Descriptor& err, Clock::time_point deadline, ProgramRun& run) {
  std::array<pollfd, 2> waiting{{{out.number(), POLLIN, 0}, {err.number(), POLLIN, 0}}};
  const std::array<std::string*, 2> texts{&run.out, &run.err};
  std::array<char, 65536> buffer;
  while (waiting[0].fd >= 0 || waiting[1].fd >= 0) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - Clock::now()).count();
    if (left <= 0) return false;
    if (poll(waiting.data(), waiting.size(), static_cast<int>(left)) < 0 && errno != EINTR)
      ThrowErrno("poll");
    for (std::size_t i = 0; i < waiting.size(); ++i) {
      if (waiting[i].fd < 0 || waiting[i].revents == 0) continue;
      const ssize_t count = read(waiting[i].fd, buffer.data(), buffer.size());
      if (count > 0) {
        texts[i]->append(buffer.data(), static_cast<std::size_t>(count));
      } else if (count == 0 || errno != EINTR) {
        waiting[i].fd = -1;
      }
    }
  }
  return true;
}

int WaitFor(pid_t child) {
  int status = 0;
  while (waitpid(child, &status, 0) < 0) {
    if (errno != EINTR) ThrowErrno("waitpid");
  }
  return WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
}

}  // namespace

ProgramRun RunProgram(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                      const RunOptions& options) {
  std::vector<std::string> words{program.string()};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<std::string> settings = EnvironmentWith(options.environment);
  const std::vector<char*> argv = PointersTo(words);
  const std::vector<char*> envp = PointersTo(settings);
  const char* folder = options.working_folder.empty() ? nullptr : options.working_folder.c_str();

  auto [out, out_of_child] = MakePipe();
  auto [err, err_of_child] = MakePipe();
  auto [failure, failure_of_child] = MakePipe();
  const pid_t child = fork();
  if (child < 0) ThrowErrno("fork");
  if (child == 0) {
    Become(folder, argv.data(), envp.data(), out_of_child.number(), err_of_child.number(),
           failure_of_child.number());
  }
  out_of_child.Close();
  err_of_child.Close();
  failure_of_child.Close();

  int reason = 0;
  if (read(failure.number(), &reason, sizeof reason) == static_cast<ssize_t>(sizeof reason)) {
    WaitFor(child);
    throw std::system_error(reason, std::generic_category(), program.string());
  }
  ProgramRun run;
  const auto timeout =
      std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(options.timeout_s));
  std::jthread beside;
  if (options.while_running) beside = std::jthread([&] { options.while_running(child); });
  const bool ended = ReadBoth(out, err, Clock::now() + timeout, run);
  if (!ended) kill(-child, SIGKILL);
  if (beside.joinable()) beside.join();
  run.exit_status = WaitFor(child);
  if (!ended)
    throw std::runtime_error(program.string() + ": took longer than its timeout; it said: " + run.err);
  return run;
}

}  // namespace elbowroom::test_support
