#include "cad_import/import_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cad_import/file_format.h"
#include "cad_import/file_unit.h"
#include "cad_import/import_protocol.h"
#include "cad_import/import_worker.h"
#include "core/error.h"

namespace elbowroom::cad_import {
namespace {

using core::Error;
using core::ErrorKind;
using Clock = std::chrono::steady_clock;

constexpr int kPollMs = 50;  // how soon a cancel is heard

class Descriptor {
 public:
  explicit Descriptor(int number = -1) : number_(number) {}
  ~Descriptor() { Close(); }
  Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  Descriptor& operator=(Descriptor&&) = delete;
  // The same file by another number, beyond those that a child finds its own under.
  [[nodiscard]] Descriptor OutOfTheWay() const {
    return Descriptor(::fcntl(number_, F_DUPFD_CLOEXEC, kResultDescriptor + 1));
  }
  void Close() {
    if (number_ >= 0) ::close(std::exchange(number_, -1));
  }
  [[nodiscard]] int number() const { return number_; }

 private:
  int number_;
};

[[noreturn]] void FailToStart(const char* what) {
  throw Error(ErrorKind::kCad,
              fmt::format("can't start a process to import with ({}: {}); close other programs", what,
                          std::strerror(errno)));
}

struct Pipe {
  Descriptor from, to;
};
Pipe MakePipe() {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) FailToStart("a pipe");
  return {Descriptor(ends[0]), Descriptor(ends[1])};
}

Descriptor MakeMemoryFile() {
  Descriptor file(::memfd_create("import", MFD_CLOEXEC | MFD_ALLOW_SEALING));
  if (file.number() < 0) FailToStart("a file in memory");
  return file;
}

// The child of one import. Killed, if it still runs, and waited for at the end of its life.
class Child {
 public:
  explicit Child(pid_t pid) : pid_(pid) {}
  ~Child() {
    if (!status_) {
      Kill();
      (void)Wait();
    }
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  void Kill() const { ::kill(pid_, SIGKILL); }
  int Wait() { return *Ask(0); }
  // Nothing while it runs.
  std::optional<int> Status() { return Ask(WNOHANG); }

 private:
  std::optional<int> Ask(int options) {
    int status = 0;
    while (!status_) {
      const pid_t ended = ::waitpid(pid_, &status, options);
      if (ended == pid_) status_ = status;
      if (ended == 0) break;
      core::Require(ended > 0 || errno == EINTR, "a child is waited for by its parent alone");
    }
    return status_;
  }

  pid_t pid_;
  std::optional<int> status_;
};

// posix_spawn, as forking a process that has threads leaves locks that nobody opens.
pid_t Spawn(const std::vector<std::string>& arguments, const Descriptor& messages, const Descriptor& result) {
  const Descriptor spare_messages = messages.OutOfTheWay(), spare_result = result.OutOfTheWay();
  if (spare_messages.number() < 0 || spare_result.number() < 0) FailToStart("its pipes");
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, spare_messages.number(), kMessageDescriptor);
  posix_spawn_file_actions_adddup2(&actions, spare_result.number(), kResultDescriptor);
  posix_spawn_file_actions_addclosefrom_np(&actions, kResultDescriptor + 1);
  // A group of its own: Ctrl-C is for the parent to hear. And its signals as they are at the start of a
  // program.
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  sigset_t none, all;
  sigemptyset(&none);
  sigfillset(&all);
  posix_spawnattr_setsigmask(&attributes, &none);
  posix_spawnattr_setsigdefault(&attributes, &all);
  posix_spawnattr_setpgroup(&attributes, 0);
  posix_spawnattr_setflags(&attributes,
                           POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
  std::vector<char*> argv;
  argv.reserve(arguments.size() + 1);
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  pid_t pid = 0;
  const int error = ::posix_spawn(&pid, "/proc/self/exe", &actions, &attributes, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  posix_spawnattr_destroy(&attributes);
  if (error != 0) {
    errno = error;
    FailToStart("this program");
  }
  return pid;
}

// Lines as they come through the pipe.
class MessageReader {
 public:
  explicit MessageReader(int pipe) : pipe_(pipe) {}

  // Waits a moment for more; false: there is no more to come.
  bool Read(const std::function<void(const ImportMessage&)>& hear) {
    pollfd waiting{pipe_, POLLIN, 0};
    if (::poll(&waiting, 1, kPollMs) <= 0) return true;
    std::array<char, 4096> chunk{};
    const ssize_t size = ::read(pipe_, chunk.data(), chunk.size());
    if (size < 0) return errno == EINTR;
    if (size == 0) return false;
    for (const char letter : std::string_view(chunk.data(), static_cast<std::size_t>(size))) {
      if (letter == '\n') {
        hear(ParseMessage(line_));
        line_.clear();
      } else if (line_.size() < kLongestMessageBytes) {
        line_ += letter;
      }
    }
    return true;
  }

 private:
  int pipe_;
  std::string line_;
};

std::string MemoryText(std::int64_t bytes) {
  constexpr double kGib = 1024.0 * 1024.0 * 1024.0;
  return fmt::format("{:.3g} GiB", static_cast<double>(bytes) / kGib);
}

// What an end without a word means.
Error ErrorOfEnd(const std::string& where, int status, const ImportLimits& limits) {
  if (WIFSIGNALED(status)) {
    const int signal = WTERMSIG(status);
    if (signal == SIGXCPU) {
      return {ErrorKind::kCad, fmt::format("{}: reading it took more than {} s of the processor; export a "
                                           "simpler model",
                                           where, limits.time_s)};
    }
    if (signal == SIGKILL) {
      return {ErrorKind::kCad,
              fmt::format("{}: reading it was stopped from outside, perhaps as the system was "
                          "short of memory; try it again, or with a smaller --memory-gib",
                          where)};
    }
    if (signal == SIGXFSZ) {
      return {ErrorKind::kCad,
              fmt::format("{}: it makes a larger model than the limit of {} allows; export a coarser one",
                          where, MemoryText(limits.memory_bytes))};
    }
    return {ErrorKind::kCad,
            fmt::format("{}: its reader crashed ({}), so the file is damaged or of a kind that the reader "
                        "can't take; export it again, or in another format",
                        where, ::sigabbrev_np(signal))};
  }
  return {ErrorKind::kCad,
          fmt::format("{}: its reader ended without an answer (status {}); export it again, or in "
                      "another format",
                      where, WEXITSTATUS(status))};
}

}  // namespace

MappedFile ImportInChild(const std::filesystem::path& file, const ImportOptions& options,
                         const core::Progress& progress, const std::stop_token& stop) {
  core::Require(ServesImports(), "a program that imports calls ServeImport first");
  const std::string where = file.string();
  Pipe pipe = MakePipe();
  const Descriptor result = MakeMemoryFile();
  Child child(
      Spawn({"elbowroom", std::string(kImportWorkerArgument), where, NameOrDash(options.unit),
             NameOrDash(options.unit_if_file_has_none), fmt::format("{}", options.tolerance_mm.value_or(0.0)),
             fmt::format("{}", options.limits.memory_bytes), fmt::format("{}", options.limits.time_s)},
            pipe.to, result));
  pipe.to.Close();

  const std::optional<FileFormat> format = FindFormat(file);
  const char* coarser = format && IsBoundaryRepresentation(*format) ? "--tolerance or " : "";
  bool is_done = false;
  std::optional<Error> failure;
  const auto hear = [&](const ImportMessage& message) {
    if (const auto* step = std::get_if<ProgressMessage>(&message)) {
      progress.Report(step->done, step->total, step->what);
    } else if (const auto* failed = std::get_if<FailureMessage>(&message)) {
      failure.emplace(failed->kind, failed->what);
    } else if (std::holds_alternative<OutOfMemoryMessage>(message)) {
      failure.emplace(
          ErrorKind::kCad,
          fmt::format("{}: reading it takes more than {} of memory; export a simpler model, or run "
                      "`elbowroom import` on it with a larger {}--memory-gib",
                      where, MemoryText(options.limits.memory_bytes), coarser));
    } else if (std::holds_alternative<DoneMessage>(message)) {
      is_done = true;
    }
  };
  const auto deadline = Clock::now() + std::chrono::duration<double>(options.limits.time_s);
  const auto check = [&] {
    core::ThrowIfStopped(stop, "import of " + where);
    if (Clock::now() < deadline) return;
    throw Error(
        ErrorKind::kCad,
        fmt::format("{}: reading it takes more than {} s; export a simpler model, or run `elbowroom import` "
                    "on it with a larger {}--time-s",
                    where, options.limits.time_s, coarser));
  };
  MessageReader reader(pipe.from.number());
  while (reader.Read(hear)) check();
  // It has closed the pipe, so it is about to end; or it never will.
  while (!child.Status()) {
    check();
    ::poll(nullptr, 0, 1);
  }
  const int status = child.Wait();
  if (failure) throw Error(*failure);
  if (!is_done || !WIFEXITED(status) || WEXITSTATUS(status) != 0)
    throw ErrorOfEnd(where, status, options.limits);
  // Nothing that the child may have left behind can change it from here on.
  const bool is_sealed = ::fcntl(result.number(), F_ADD_SEALS, F_SEAL_SHRINK | F_SEAL_WRITE) == 0;
  std::optional<MappedFile> packed = is_sealed ? MappedFile::Of(result.number()) : std::nullopt;
  if (packed) return *std::move(packed);
  throw Error(ErrorKind::kCad, fmt::format("{}: its model can't be read back; import it again", where));
}

}  // namespace elbowroom::cad_import
