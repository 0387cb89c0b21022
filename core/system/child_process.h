// Programs that run as children of this one, so that no file can take this one down: how they are started,
// what they may take, how they are waited for and ended.
#pragma once

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace elbowroom::core {

// An open file, pipe or socket, closed at the end of its life.
class Descriptor {
 public:
  explicit Descriptor(int number = -1) : number_(number) {}
  ~Descriptor() { Close(); }
  Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept;
  void Close();
  [[nodiscard]] int number() const { return number_; }
  [[nodiscard]] bool is_open() const { return number_ >= 0; }

 private:
  int number_;
};

// All of these are closed in what this program starts. Throw: Error{kFile} when the system has none left.
struct Pipe {
  Descriptor from, to;
};
[[nodiscard]] Pipe MakePipe();
[[nodiscard]] Pipe MakeSocketPair();  // of packets: what is sent at once is received at once
[[nodiscard]] Descriptor MakeMemoryFile(const char* name);

// Where a child finds the first descriptor that it is given; the others follow.
inline constexpr int kFirstGivenDescriptor = 3;

struct ChildProgram {
  std::filesystem::path program = "/proc/self/exe";
  std::vector<std::string> arguments;      // the first is its name
  std::vector<const Descriptor*> gives{};  // beside these it has none of this program's
};

// What ended a wait.
enum class Woken { kReady, kStopped, kTooLate };
using Deadline = std::optional<std::chrono::steady_clock::time_point>;  // nothing: for ever

// A child of this program: its input is empty, what it prints is thrown away, Ctrl-C doesn't reach it.
// Killed, if it still runs, and waited for at the end of its life. Thread: one at a time.
class Child {
 public:
  // Throws: Error{kFile} saying why it can't be started.
  explicit Child(const ChildProgram& program);
  ~Child();
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  void Kill() const;
  int Wait();                   // the status, as waitpid gives it
  std::optional<int> Status();  // nothing while it runs
  [[nodiscard]] Woken WaitForEnd(const std::stop_token& stop, const Deadline& deadline);

 private:
  std::optional<int> Ask(int options);

  int pid_;
  std::optional<int> status_;
};

// "crashed (SEGV)", "was stopped from outside", "ended (status 1)": of a status that waitpid gave.
[[nodiscard]] std::string TextOfEnd(int status);

// Waits until there is something to read, or its other end is closed. A stop is heard within 50 ms.
[[nodiscard]] Woken WaitToRead(const Descriptor& descriptor, const std::stop_token& stop,
                               const Deadline& deadline);

// False: nobody listens any more.
[[nodiscard]] bool WriteAll(int descriptor, std::span<const std::byte> bytes);

// What a child says, made one printable line of at most `most_bytes`.
[[nodiscard]] std::string PrintableLine(std::string_view text, std::size_t most_bytes);

// For a child, of itself.
struct OwnLimits {
  std::optional<double> memory_bytes;  // of addresses; not under sanitizers, which reserve all there are
  std::optional<double> file_bytes;    // of what it writes
  std::optional<double> cpu_s;         // on all threads together
};
// It dies with the thread that started it, gains no rights, leaves no core file, and takes no more than this.
void LimitMyself(const OwnLimits& limits);

}  // namespace elbowroom::core
