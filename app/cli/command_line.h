// The command line: arguments become commands, and failures become one line and an exit status.
#pragma once

#include <functional>

#include "app/cli/options/command.h"

namespace elbowroom::cli {

// Opens the window and returns its exit status when it is closed; throws core::Error.
using OpenConsole = std::function<int(const ConsoleRequest&)>;

// Exit status: 0 on success, 2 on wrong usage, 1 on anything else, with one line on stderr that says what,
// where and what to do. Null `open_console`: this build has no window.
[[nodiscard]] int RunCommandLine(int argc, char** argv, const OpenConsole& open_console);

}  // namespace elbowroom::cli
