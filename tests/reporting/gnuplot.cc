#include "tests/reporting/gnuplot.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"
#include "tests/support/run_program.h"

namespace elbowroom::reporting {

void RunGnuplot(const std::filesystem::path& script, const std::string& program) {
  constexpr int kNotFound = 127;  // as env has it
  const auto run = test_support::RunProgram("/usr/bin/env", {program, script.filename().string()},
                                            {.working_folder = script.parent_path()});
  if (run.exit_status == 0) return;
  if (run.exit_status == kNotFound) {
    throw core::Error(
        core::ErrorKind::kFile,
        fmt::format("'{}' isn't installed, so there is no picture; install the package gnuplot-nox",
                    program));
  }
  std::string said = run.err;
  std::ranges::replace(said, '\n', ' ');
  throw core::Error(core::ErrorKind::kFile, fmt::format("gnuplot failed on {}: {}", script.string(), said));
}

}  // namespace elbowroom::reporting
