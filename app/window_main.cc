// The program that takes the place of elbowroom when the command line asks for the window, so that only the
// window loads Qt.
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include "app/cli/command_line.h"
#include "app/cli/interrupt.h"
#include "app/cli/standard_streams.h"
#include "app/console/console_main.h"
#include "cad_import/import_worker.h"
#include "core/system/kept_memory.h"

int main(int argc, char** argv) {
  elbowroom::cli::GuardStandardStreams();          // before a file can be opened
  elbowroom::cad_import::ServeImport(argc, argv);  // returns unless this is a child that imports
  elbowroom::core::KeepFreedMemory();
  spdlog::set_default_logger(spdlog::stderr_color_mt("elbowroom"));  // stdout is for results
  return elbowroom::cli::RunCommandLine(argc, argv, [](const elbowroom::cli::ConsoleRequest& request) {
    const elbowroom::cli::InterruptWatch interrupt;  // before Qt's threads
    elbowroom::console::ConsoleOptions options;
    options.stop = interrupt.stop();
    options.trial_file = request.trial_file;
    options.demo = request.demo;
    options.session = request.session;
    if (request.picture) {
      options.picture = elbowroom::console::PictureOrder{request.picture->png, request.picture->after_s,
                                                         request.picture->gap_mm, !request.picture->gap_mm};
    }
    return elbowroom::console::RunConsole(options);
  });
}
