#include "core/system/child_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

#include "core/error.h"

namespace elbowroom::core {
namespace {

constexpr int kPollMs = 50;  // how soon a stop is noticed

[[noreturn]] void FailToStart(const char* what, int error) {
  throw Error(ErrorKind::kFile, fmt::format("can't start a process to read files with ({}: {}); close other "
                                            "programs",
                                            what, std::strerror(error)));
}

Pipe Ends(int result, const std::array<int, 2>& ends, const char* what) {
  if (result != 0) FailToStart(what, errno);
  return {Descriptor(ends[0]), Descriptor(ends[1])};
}

// posix_spawn's two lists, freed with this object.
class SpawnPlan {
 public:
  SpawnPlan() {
    posix_spawn_file_actions_init(&actions_);
    posix_spawnattr_init(&attributes_);
  }
  ~SpawnPlan() {
    posix_spawn_file_actions_destroy(&actions_);
    posix_spawnattr_destroy(&attributes_);
  }
  SpawnPlan(const SpawnPlan&) = delete;
  SpawnPlan& operator=(const SpawnPlan&) = delete;

  // `given` have numbers beyond those under which the child finds them, so that none is overwritten before it
  // is copied.
  void Give(const std::vector<Descriptor>& given) {
    posix_spawn_file_actions_addopen(&actions_, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&actions_, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_addopen(&actions_, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
    int place = kFirstGivenDescriptor;
    for (const Descriptor& descriptor : given)
      posix_spawn_file_actions_adddup2(&actions_, descriptor.number(), place++);
    posix_spawn_file_actions_addclosefrom_np(&actions_, place);
  }

  // The child gets a process group of its own, so that Ctrl-C reaches only the parent, and default signal
  // handling.
  void SetApart() {
    sigset_t none, all;
    sigemptyset(&none);
    sigfillset(&all);
    posix_spawnattr_setsigmask(&attributes_, &none);
    posix_spawnattr_setsigdefault(&attributes_, &all);
    posix_spawnattr_setpgroup(&attributes_, 0);
    posix_spawnattr_setflags(&attributes_,
                             POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
  }

  [[nodiscard]] pid_t Run(const char* program, char* const* argv) const {
    pid_t pid = 0;
    const int error = ::posix_spawn(&pid, program, &actions_, &attributes_, argv, environ);
    if (error != 0) FailToStart(program, error);
    return pid;
  }

 private:
  posix_spawn_file_actions_t actions_{};
  posix_spawnattr_t attributes_{};
};

// Uses posix_spawn, because in a fork of a process with threads the locks of the other threads stay locked.
pid_t Spawn(const ChildProgram& program) {
  const int beyond = kFirstGivenDescriptor + static_cast<int>(program.gives.size());
  std::vector<Descriptor> given;
  for (const Descriptor* descriptor : program.gives) {
    given.emplace_back(::fcntl(descriptor->number(), F_DUPFD_CLOEXEC, beyond));
    if (!given.back().is_open()) FailToStart("its pipes", errno);
  }
  SpawnPlan plan;
  plan.Give(given);
  plan.SetApart();
  std::vector<char*> argv;
  argv.reserve(program.arguments.size() + 1);
  for (const std::string& argument : program.arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  return plan.Run(program.program.c_str(), argv.data());
}

void Limit(__rlimit_resource resource, double most) {
  const auto value = static_cast<rlim_t>(most);
  const rlimit limit{value, value};
  ::setrlimit(resource, &limit);
}

std::optional<Woken> WokenBy(const std::stop_token& stop, const Deadline& deadline) {
  if (stop.stop_requested()) return Woken::kStopped;
  if (deadline && std::chrono::steady_clock::now() >= *deadline) return Woken::kTooLate;
  return std::nullopt;
}

}  // namespace

Descriptor& Descriptor::operator=(Descriptor&& other) noexcept {
  Close();
  number_ = std::exchange(other.number_, -1);
  return *this;
}

void Descriptor::Close() {
  if (number_ >= 0) ::close(std::exchange(number_, -1));
}

Pipe MakePipe() {
  std::array<int, 2> ends{};
  const int result = ::pipe2(ends.data(), O_CLOEXEC);
  return Ends(result, ends, "a pipe");
}

Pipe MakeSocketPair() {
  std::array<int, 2> ends{};
  const int result = ::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends.data());
  return Ends(result, ends, "a socket");
}

Descriptor MakeMemoryFile(const char* name) {
  Descriptor file(::memfd_create(name, MFD_CLOEXEC | MFD_ALLOW_SEALING));
  if (!file.is_open()) FailToStart("a file in memory", errno);
  return file;
}

Child::Child(const ChildProgram& program) : pid_(Spawn(program)) {}

Child::~Child() {
  if (status_) return;
  Kill();
  (void)Wait();
}

void Child::Kill() const { ::kill(pid_, SIGKILL); }
void Child::AskToEnd() const { ::kill(pid_, SIGTERM); }
int Child::Wait() { return *Ask(0); }
std::optional<int> Child::Status() { return Ask(WNOHANG); }

Woken Child::WaitForEnd(const std::stop_token& stop, const Deadline& deadline) {
  while (!Status()) {
    if (const auto woken = WokenBy(stop, deadline)) return *woken;
    ::poll(nullptr, 0, 1);
  }
  return Woken::kReady;
}

std::optional<int> Child::Ask(int options) {
  int status = 0;
  while (!status_) {
    const pid_t ended = ::waitpid(pid_, &status, options);
    if (ended == pid_) status_ = status;
    if (ended == 0) break;
    Require(ended > 0 || errno == EINTR, "a child is waited for by its parent alone");
  }
  return status_;
}

std::string TextOfEnd(int status) {
  if (!WIFSIGNALED(status)) return fmt::format("ended (status {})", WEXITSTATUS(status));
  if (WTERMSIG(status) == SIGKILL) return "was stopped from outside";
  return fmt::format("crashed ({})", ::sigabbrev_np(WTERMSIG(status)));
}

Woken WaitToRead(const Descriptor& descriptor, const std::stop_token& stop, const Deadline& deadline) {
  pollfd waiting{descriptor.number(), POLLIN, 0};
  for (;;) {
    if (const auto woken = WokenBy(stop, deadline)) return *woken;
    if (::poll(&waiting, 1, kPollMs) > 0) return Woken::kReady;
  }
}

bool WriteAll(int descriptor, std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t size = ::write(descriptor, bytes.data(), bytes.size());
    if (size < 0 && errno == EINTR) continue;
    if (size <= 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(size));
  }
  return true;
}

std::string PrintableLine(std::string_view text, std::size_t most_bytes) {
  std::string line(text.substr(0, most_bytes));
  std::ranges::replace_if(
      line, [](unsigned char c) { return c < 0x20 || c == 0x7f; }, ' ');
  return line;
}

void LimitMyself(const OwnLimits& limits) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
  Limit(RLIMIT_CORE, 0);
  if (limits.cpu_s) Limit(RLIMIT_CPU, *limits.cpu_s);
  if (limits.file_bytes) Limit(RLIMIT_FSIZE, *limits.file_bytes);
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
  if (limits.memory_bytes) Limit(RLIMIT_AS, *limits.memory_bytes);
#endif
}

}  // namespace elbowroom::core
