// The program: the command line, and the window that it may open.
#include "app/cli/command_line.h"
#ifdef ELBOWROOM_WITH_CONSOLE
#include "app/console/console_main.h"
#endif

int main(int argc, char** argv) {
#ifdef ELBOWROOM_WITH_CONSOLE
  return elbowroom::cli::RunCommandLine(argc, argv, [](const elbowroom::cli::ConsoleRequest& request) {
    elbowroom::console::RunConsole({request.trial_file, request.demo, request.session});
  });
#else
  return elbowroom::cli::RunCommandLine(argc, argv, {});
#endif
}
