// elbowroom open FILE: what a desktop runs when it, a trial, a layout or a session is opened. Hidden: at a
// terminal there is `trial run`.
#include <filesystem>
#include <memory>

#include "app/cli/options/command.h"

namespace elbowroom::cli {

void AddOpenCommand(CLI::App& app, Choice* choice) {
  CLI::App* command = app.add_subcommand("open", "open a trial, a layout or a session in the window");
  command->group("");
  auto file = std::make_shared<std::filesystem::path>();
  command->add_option("FILE", *file,
                      "a TRIAL.toml, a LAYOUT.toml, or a session (.db) to review; without: an empty window");
  command->callback([=] { choice->console = ConsoleRequest{*file, false, {}, {}}; });
}

}  // namespace elbowroom::cli
