// The program: it runs the command line. The window is another program beside it.
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include "app/cli/command_line.h"
#include "app/cli/standard_streams.h"
#include "cad_import/import_worker.h"
#include "core/system/kept_memory.h"
#ifdef ELBOWROOM_WINDOW_PROGRAM
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "core/error.h"
#endif

namespace elbowroom {
namespace {

cli::OpenConsole WayToTheWindow([[maybe_unused]] char** argv) {
#ifdef ELBOWROOM_WINDOW_PROGRAM
  // The window's program takes the same arguments; execv() puts it in the place of this process.
  return [argv](const cli::ConsoleRequest&) -> int {
    const auto program =
        std::filesystem::read_symlink("/proc/self/exe").parent_path() / ELBOWROOM_WINDOW_PROGRAM;
    ::execv(program.c_str(), argv);
    throw core::Error(
        core::ErrorKind::kFile,
        fmt::format("{}: can't be started ({}); it belongs beside the program: build or install them "
                    "together",
                    program.string(), std::strerror(errno)));
  };
#else
  return {};
#endif
}

}  // namespace
}  // namespace elbowroom

int main(int argc, char** argv) {
  elbowroom::cli::GuardStandardStreams();          // before a file can be opened
  elbowroom::cad_import::ServeImport(argc, argv);  // returns unless this is a child that imports
  elbowroom::core::KeepFreedMemory();
  spdlog::set_default_logger(spdlog::stderr_color_mt("elbowroom"));  // stdout is for results
  return elbowroom::cli::RunCommandLine(argc, argv, elbowroom::WayToTheWindow(argv));
}
