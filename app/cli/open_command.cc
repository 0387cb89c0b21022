// elbowroom open FILE: what a desktop runs when it, a trial or a layout is opened. Hidden: at a terminal there is
// `trial run`.
#include <filesystem>
#include <memory>

#include "app/cli/options/command.h"

namespace elbowroom::cli {

void AddOpenCommand(CLI::App& app, Choice* choice) {
  CLI::App* command = app.add_subcommand("open", "open a trial or a layout in the window");
  command->group("");
  auto file = std::make_shared<std::filesystem::path>();
  command->add_option("FILE", *file, "a TRIAL.toml or a LAYOUT.toml; without: an empty window");
  command->callback([=] { choice->console = ConsoleRequest{*file, false, {}, {}}; });
}

}  // namespace elbowroom::cli
