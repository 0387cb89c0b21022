// elbowroom reference FORM: the command line as a manual page or a completion script. Hidden: the build calls
// it.
#include <memory>
#include <string>
#include <vector>

#include "app/cli/options/command.h"
#include "app/cli/reference/completion.h"
#include "app/cli/reference/manual_page.h"
#include "app/control/versions.h"

namespace elbowroom::cli {
namespace {

std::string Reference(const std::string& form, const std::vector<CommandEntry>& table) {
  if (form == "bash") return BashCompletion(table);
  if (form == "zsh") return ZshCompletion(table);
  if (form == "fish") return FishCompletion(table);
  return ManualPage(table, control::ProgramVersion());
}

}  // namespace

void AddReferenceCommand(CLI::App& app, Choice* choice) {
  CLI::App* command = app.add_subcommand("reference", "what --help says of all commands, in another form");
  command->group("");
  auto form = std::make_shared<std::string>();
  command->add_option("FORM", *form, "man, bash, zsh or fish")
      ->required()
      ->check(CLI::IsMember({"man", "bash", "zsh", "fish"}));
  command->callback([form, choice, &app] {
    choice->action = [form, &app](const CommandContext&) {
      CommandResult result;
      result.text = Reference(*form, CommandTable(app));
      if (result.text.ends_with('\n')) result.text.pop_back();  // one is printed behind it
      result.json["text"] = result.text;
      return result;
    };
  });
}

}  // namespace elbowroom::cli
