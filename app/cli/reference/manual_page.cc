#include "app/cli/reference/manual_page.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <sstream>

namespace elbowroom::cli {
namespace {

// Text that stands for itself. "\-" is the character of options, which can be searched for and copied.
std::string Roff(std::string_view text) {
  std::string escaped;
  for (const char character : text) {
    if (character == '\\') {
      escaped += "\\e";
    } else if (character == '-') {
      escaped += "\\-";
    } else if (character == '\'') {
      escaped += "\\(aq";
    } else {
      escaped += character == '\n' ? ' ' : character;
    }
  }
  // A point at a line's begin would make it a request.
  return escaped.starts_with('.') ? "\\&" + escaped : escaped;
}

// As an argument of a request.
std::string RoffQuoted(std::string_view text) {
  std::string quoted = "\"";
  for (const char character : Roff(text))
    quoted += character == '"' ? std::string("\\(dq") : std::string(1, character);
  return quoted + '"';
}

std::string ArgumentText(const ArgumentEntry& argument) {
  std::string text = fmt::format(".TP\n\\fB{}\\fR", Roff(fmt::format("{}", fmt::join(argument.names, ", "))));
  if (!argument.value.empty()) text += " " + Roff(argument.value);
  return text + "\n" + Roff(argument.description) + "\n";
}

std::string ArgumentsText(const CommandEntry& command) {
  std::string text;
  for (const ArgumentEntry& argument : command.positionals) text += ArgumentText(argument);
  for (const ArgumentEntry& argument : command.options) text += ArgumentText(argument);
  return text;
}

// Lines that stay as they are.
std::string FooterText(const std::string& footer) {
  if (footer.empty()) return "";
  std::string text = ".PP\n.nf\n";
  std::istringstream lines(footer);
  for (std::string line; std::getline(lines, line);) text += Roff(line) + "\n";
  return text + ".fi\n";
}

std::string CommandSection(const CommandEntry& command) {
  return fmt::format(".SS {}\n.B {}\n.PP\n{}\n{}{}", RoffQuoted(JoinedPath(command)), Roff(command.usage),
                     Roff(command.description), ArgumentsText(command), FooterText(command.footer));
}

constexpr std::string_view kEnd = R"(.SH EXIT STATUS
.TP
.B 0
success
.TP
.B 1
any other failure; one line on the standard error says what, where, and what to do
.TP
.B 2
wrong usage
.SH SEE ALSO
The user guide, among the documents that are installed with the program.
)";

}  // namespace

std::string ManualPage(const std::vector<CommandEntry>& table, std::string_view version) {
  const CommandEntry& program = CommandAt(table, {});
  std::string about = program.description;
  if (about.ends_with('.')) about.pop_back();
  std::string page = fmt::format(
      ".TH ELBOWROOM 1 \"\" {} \"User Commands\"\n.SH NAME\nelbowroom \\- {}\n.SH SYNOPSIS\n.B {}\n"
      ".SH DESCRIPTION\nWithout a command it opens the window.\n.SH OPTIONS\nThese go with every command.\n{}"
      ".SH COMMANDS\n",
      RoffQuoted(fmt::format("Elbowroom {}", version)), Roff(about), Roff(program.usage),
      ArgumentsText(program));
  for (const CommandEntry& command : table)
    if (!command.path.empty()) page += CommandSection(command);
  return page.append(kEnd);
}

}  // namespace elbowroom::cli
