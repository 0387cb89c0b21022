// Runs a program as a user would and keeps all that it said.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace elbowroom::test_support {

struct ProgramRun {
  int exit_status = 0;  // 128 + n when signal n ended it
  std::string out;      // what it wrote on stdout
  std::string err;      // on stderr
};

// How many times as long programs may take in this build: a demo takes six times as long under
// AddressSanitizer.
#ifdef __SANITIZE_ADDRESS__
inline constexpr double kSlowdown = 6.0;
#else
inline constexpr double kSlowdown = 1.0;
#endif

struct RunOptions {
  std::filesystem::path working_folder{};            // empty: the test's own
  std::map<std::string, std::string> environment{};  // set beside the test's own
  double timeout_s = 300.0 * kSlowdown;
  // Called on a thread of its own with the program's process id once it runs; waited for before it is reaped.
  std::function<void(int process)> while_running{};
};

// Waits for it to end; its standard input is empty. `arguments` don't include the program's name.
// Throws: std::system_error when it can't be started; std::runtime_error, after killing it and its children,
// when it takes longer than the timeout.
[[nodiscard]] ProgramRun RunProgram(const std::filesystem::path& program,
                                    const std::vector<std::string>& arguments,
                                    const RunOptions& options = {});

}  // namespace elbowroom::test_support
