// elbowroom report S.db --out DIR: the report of a recorded session.
#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "app/cli/options/command.h"
#include "app/control/report/session_report.h"

namespace elbowroom::cli {
namespace {

struct ReportOptions {
  std::filesystem::path session;
  std::filesystem::path out;
};

CommandResult Run(const ReportOptions& options, const CommandContext& context) {
  const control::ReportFiles files =
      control::WriteSessionReport(options.session, options.out, context.progress, context.stop);
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
  auto options = std::make_shared<ReportOptions>();
  command->add_option("SESSION", options->session, "the session (S.db)")->required();
  command->add_option("--out", options->out, "folder for the report; made if it isn't there")->required();
  command->callback(
      [=] { choice->action = [=](const CommandContext& context) { return Run(*options, context); }; });
}

}  // namespace elbowroom::cli
