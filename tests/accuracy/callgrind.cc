#include "tests/accuracy/callgrind.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "core/error.h"
#include "tests/support/run_program.h"

namespace elbowroom::accuracy {

CallgrindCount CountInstructions(const std::filesystem::path& program,
                                 const std::vector<std::string>& arguments, const std::string& function,
                                 const std::string& valgrind) {
  constexpr int kNotFound = 127;  // as env has it
  std::vector<std::string> words = {valgrind, "--tool=callgrind", "--callgrind-out-file=/dev/null",
                                    "--toggle-collect=" + function, program.string()};
  words.insert(words.end(), arguments.begin(), arguments.end());
  const auto run = test_support::RunProgram("/usr/bin/env", words);
  if (run.exit_status == kNotFound) {
    throw core::Error(
        core::ErrorKind::kFile,
        fmt::format("'{}' isn't installed, so nothing is counted; install the package valgrind", valgrind));
  }
  if (run.err.find("Unrecognised instruction") != std::string::npos)
    throw core::Error(core::ErrorKind::kFile,
                      fmt::format("valgrind doesn't know an instruction that {} executes on this processor, "
                                  "so nothing is counted; count on another machine",
                                  program.string()));
  const std::string marker = "Collected : ";
  const std::size_t place = run.err.find(marker);
  CallgrindCount count{0, run.out.substr(0, run.out.find('\n'))};
  if (place != std::string::npos) {
    std::from_chars(run.err.data() + place + marker.size(), run.err.data() + run.err.size(),
                    count.instructions);
  }
  if (run.exit_status == 0 && count.instructions > 0) return count;
  std::string said = run.err;
  std::ranges::replace(said, '\n', ' ');
  throw core::Error(core::ErrorKind::kFile, fmt::format("callgrind counted nothing of {} in {}: {}", function,
                                                        program.string(), said));
}

}  // namespace elbowroom::accuracy
