// Child processes of this program, which read files that could make a process crash: how they are started,
// limited, waited for and ended.
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

// A child doesn't inherit any of these (close-on-exec), unless ChildProgram::gives names it. All three
// functions throw: Error{kFile} when the system can't make one.
struct Pipe {
  Descriptor from, to;
};
[[nodiscard]] Pipe MakePipe();
[[nodiscard]] Pipe MakeSocketPair();  // of packets: one send is one receive
[[nodiscard]] Descriptor MakeMemoryFile(const char* name);

// The number under which a child finds the first descriptor that it is given; the others follow in order.
inline constexpr int kFirstGivenDescriptor = 3;

struct ChildProgram {
  std::filesystem::path program = "/proc/self/exe";
  std::vector<std::string> arguments;      // the first is the program's name (argv[0])
  std::vector<const Descriptor*> gives{};  // it inherits no other descriptors of this program
};

// Why a wait ended.
enum class Woken { kReady, kStopped, kTooLate };
using Deadline = std::optional<std::chrono::steady_clock::time_point>;  // nothing: no limit

// A child of this program. Its input is empty, its output is thrown away, and Ctrl-C doesn't reach it. The
// destructor kills it if it still runs, and waits for it. Thread: one at a time.
class Child {
 public:
  // Throws: Error{kFile} saying why it can't be started.
  explicit Child(const ChildProgram& program);
  ~Child();
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  void Kill() const;
  void AskToEnd() const;        // SIGTERM
  int Wait();                   // until it has ended; the status is waitpid's
  std::optional<int> Status();  // nothing while it runs
  [[nodiscard]] Woken WaitForEnd(const std::stop_token& stop, const Deadline& deadline);

 private:
  std::optional<int> Ask(int options);

  int pid_;
  std::optional<int> status_;
};

// Describes a status that waitpid gave: "crashed (SEGV)", "was stopped from outside", "ended (status 1)".
[[nodiscard]] std::string TextOfEnd(int status);

// Waits until there is something to read, or the other end is closed. A stop is noticed within 50 ms.
[[nodiscard]] Woken WaitToRead(const Descriptor& descriptor, const std::stop_token& stop,
                               const Deadline& deadline);

// False: not all bytes can be written, as when the other end is closed.
[[nodiscard]] bool WriteAll(int descriptor, std::span<const std::byte> bytes);

// The first `most_bytes` of a child's message, with a space for each control character.
[[nodiscard]] std::string PrintableLine(std::string_view text, std::size_t most_bytes);

// The limits that a child sets for itself.
struct OwnLimits {
  std::optional<double> memory_bytes;  // address space; not set under sanitizers, which reserve it all
  std::optional<double> file_bytes;    // size of a file that it writes
  std::optional<double> cpu_s;         // of all threads together
};
// Called by a child: it then dies with the thread that started it, can gain no rights, leaves no core file,
// and is held to `limits`.
void LimitMyself(const OwnLimits& limits);

}  // namespace elbowroom::core
