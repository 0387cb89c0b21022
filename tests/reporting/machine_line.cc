#include "tests/reporting/machine_line.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <chrono>
#include <fstream>
#include <thread>

#include "core/error.h"
#include "recon/gl/objects/egl_context.h"
#include "tests/support/run_program.h"

namespace elbowroom::reporting {
namespace {

std::string ProcessorModel() {
  std::ifstream stream("/proc/cpuinfo");
  for (std::string line; std::getline(stream, line);) {
    const std::size_t colon = line.find(": ");
    if (line.starts_with("model name") && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown processor";
}

std::string GlDriver() {
  try {
    const recon::gl::EglContext context;
    return fmt::format("{}, OpenGL {}", context.renderer(), context.version());
  } catch (const core::Error&) {
    return "no OpenGL";
  }
}

std::string Commit(const std::filesystem::path& root) {
  const auto git = [&](std::vector<std::string> words) {
    words.insert(words.begin(), {"git", "-C", root.string()});
    return test_support::RunProgram("/usr/bin/env", words);
  };
  const auto commit = git({"rev-parse", "--short=10", "HEAD"});
  if (commit.exit_status != 0) return "unknown";
  // The documents themselves change while the figures are written.
  const bool is_clean = git({"diff", "--quiet", "HEAD", "--", ".", ":!docs"}).exit_status == 0;
  return commit.out.substr(0, commit.out.find('\n')) + (is_clean ? "" : "+");
}

}  // namespace

Machine ThisMachine(const std::filesystem::path& root) {
  const auto today = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  return {ProcessorModel(),
          static_cast<int>(std::thread::hardware_concurrency()),
          GlDriver(),
          fmt::format("g++ {}", __VERSION__),
          fmt::format("{:%Y-%m-%d}", fmt::gmtime(today)),
          Commit(root)};
}

std::string ToLine(const Machine& machine) {
  return fmt::format("*{}, {} cores; {}; {}; {}, commit {}.*", machine.processor, machine.cores,
                     machine.gl_driver, machine.compiler, machine.date, machine.commit);
}

}  // namespace elbowroom::reporting
