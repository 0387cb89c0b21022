// elbowroom report S.db --out DIR: the report of a recorded session.
#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "app/cli/options/command.h"
#include "app/control/report/session_report.h"

namespace elbowroom::cli {
namespace {

struct ReportArguments {
  std::filesystem::path session;
  std::filesystem::path out;
  control::ReportOptions options;
};

CommandResult Run(const ReportArguments& arguments, const CommandContext& context) {
  const control::ReportFiles files = control::WriteSessionReport(
      arguments.session, arguments.out, context.progress, context.stop, arguments.options);
  CommandResult result;
  result.json["files"] = nlohmann::json::array();
  for (const std::filesystem::path& file : files.written) {
    result.json["files"].push_back(file.string());
    result.text += (result.text.empty() ? "" : "\n") + file.string();
  }
  return result;
}

}  // namespace

void AddReportCommand(CLI::App& app, Choice* choice) {
  CLI::App* command = app.add_subcommand(
      "report",
      "write the report of a session: report.html, report.pdf, touches.bcfzip, contacts.csv, clearance.csv");
  auto arguments = std::make_shared<ReportArguments>();
  command->add_option("SESSION", arguments->session, "the session (S.db)")->required();
  command->add_option("--out", arguments->out, "folder for the report; made if it isn't there")->required();
  command
      ->add_option(
          "--keep-out", arguments->options.keep_out_edge_mm,
          "show the keep-out volume in the 3-D view, of cells with this edge, mm (20 is a good start)")
      ->check(CLI::PositiveNumber);
  command->callback(
      [=] { choice->action = [=](const CommandContext& context) { return Run(*arguments, context); }; });
}

}  // namespace elbowroom::cli
