// elbowroom coverage RIG.yml --out DIR: what a rig can do at each place, and where another camera would help.
#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "app/cli/options/command.h"
#include "app/cli/options/unit_option.h"
#include "app/cli/options/value_json.h"
#include "app/control/coverage/coverage_job.h"
#include "app/control/coverage/coverage_pictures.h"
#include "app/control/coverage/coverage_report.h"
#include "app/control/coverage/coverage_text.h"

namespace elbowroom::cli {
namespace {

struct CoverageCommandOptions {
  control::CoverageRequest request;
  std::filesystem::path out;
};

nlohmann::json FiguresJson(const recon::CoverageFigures& figures) {
  nlohmann::json json = {{"nodes", figures.nodes},
                         {"seen_share", figures.seen_share},
                         {"unseen_share", figures.unseen_share},
                         {"reach_share", figures.reach_share},
                         {"nodes_without_uncertainty", figures.without_sigma},
                         {"nodes_without_phantom", figures.without_phantom}};
  for (const control::CoverageQuantity quantity : control::kCoverageQuantities)
    json[control::NameOf(quantity)] = JsonOf(control::SpreadOf(figures, quantity));
  if (figures.cameras_seeing) json["cameras_seeing"]["min"] = figures.fewest_cameras;
  return json;
}

nlohmann::json FiguresOrNull(const std::optional<recon::CoverageFigures>& figures) {
  return figures ? FiguresJson(*figures) : nlohmann::json();
}

nlohmann::json NextJson(const control::CoverageOutcome& outcome) {
  nlohmann::json cameras = nlohmann::json::array();
  if (!outcome.next) return cameras;
  for (const recon::ProposedCamera& camera : outcome.next->best) {
    cameras.push_back({{"position_mm", JsonOf(camera.center_mm)},
                       {"look_at_mm", JsonOf(camera.look_at_mm)},
                       {"lens_of", outcome.rig.rig.cameras[outcome.next->lens_of].name()},
                       {"gain", camera.gain},
                       {"before", FiguresJson(outcome.next->before)},
                       {"after", FiguresJson(camera.after)},
                       {"near_before", FiguresOrNull(outcome.next->near_before)},
                       {"near_after", FiguresOrNull(camera.near_after)}});
  }
  return cameras;
}

nlohmann::json PlaceOrNull(const control::CoverageOutcome& outcome, const std::optional<std::size_t>& node) {
  return node ? JsonOf(outcome.grid.PointAt(*node)) : nlohmann::json();
}

nlohmann::json CoverageJson(const control::CoverageOutcome& outcome) {
  nlohmann::json json = FiguresJson(outcome.figures);
  json["grid_mm"] = outcome.grid.edge_mm;
  json["ball_mm"] = outcome.options.ball_mm;
  json["near_mm"] = outcome.near_mm;
  json["noise_px"] = outcome.rig.noise_px;
  json["has_covariance"] = outcome.has_covariance;
  json["exact_uncertainty_mm"] = OrNull(outcome.exact_uncertainty_mm);
  json["worst_uncertainty_at_mm"] = PlaceOrNull(outcome, outcome.figures.worst_sigma);
  json["worst_phantom_at_mm"] = PlaceOrNull(outcome, outcome.figures.worst_phantom);
  json["parts"] = nlohmann::json::array();
  for (const control::PartCoverage& part : outcome.parts) {
    nlohmann::json of_part = FiguresJson(part.figures);
    of_part["part"] = part.name;
    of_part["grid_mm"] = part.grid_mm;
    json["parts"].push_back(of_part);
  }
  json["next_cameras"] = NextJson(outcome);
  json["places_tried"] = outcome.next ? outcome.next->tried : 0;
  json["warnings"] = outcome.warnings;
  json["advice"] = outcome.advice;
  json["map_ms"] = outcome.map_ms;
  json["advice_ms"] = outcome.advice_ms;
  json["time_ms"] = outcome.map_ms + outcome.advice_ms;
  return json;
}

std::string FiguresText(const std::string& where, const recon::CoverageFigures& figures) {
  using control::MmText, control::PercentText;
  std::string text = where + ":\n";
  const auto line = [&](const char* what, const std::optional<core::Spread>& spread, const auto& shown,
                        const std::string& more) {
    text += spread ? fmt::format("  {}: {} (median), {} (95 %), {} (largest){}\n", what,
                                 shown(spread->median), shown(spread->p95), shown(spread->max), more)
                   : fmt::format("  {}: nowhere\n", what);
  };
  const auto mm = [](double value) { return MmText(value) + " mm"; };
  const auto count = [](double value) { return fmt::format("{:.0f}", value); };
  line("error of a point", figures.uncertainty_mm, mm,
       fmt::format("; two cameras or more see {} of the space", PercentText(figures.seen_share)));
  line("width of a pixel", figures.footprint_mm, mm, "");
  line("cameras that see", figures.cameras_seeing, count,
       fmt::format(", {} (fewest)", figures.fewest_cameras));
  line(
      "phantom volume", figures.phantom_fraction, [](double value) { return PercentText(value); },
      fmt::format("; a thing is found in {} of the space", PercentText(figures.reach_share)));
  return text;
}

std::string CoverageText(const control::CoverageOutcome& outcome) {
  std::string text = FiguresText(fmt::format("the workspace, {} places {} mm apart", outcome.figures.nodes,
                                             control::MmText(outcome.grid.edge_mm)),
                                 outcome.figures);
  for (const control::PartCoverage& part : outcome.parts)
    text += FiguresText(fmt::format("within {} mm of part '{}', {} places", control::MmText(outcome.near_mm),
                                    part.name, part.figures.nodes),
                        part.figures);
  for (const std::string& warning : outcome.warnings) text += "warning: " + warning + "\n";
  for (const std::string& advice : outcome.advice) text += "advice: " + advice + "\n";
  return text;
}

CommandResult Run(const CoverageCommandOptions& options, const CommandContext& context) {
  const control::CoverageOutcome outcome = control::CoverRig(options.request, context.progress, context.stop);
  CommandResult result;
  result.json = CoverageJson(outcome);
  result.text = CoverageText(outcome);
  result.json["files"] = nlohmann::json::array();
  for (const std::filesystem::path& file : control::WriteCoverage(outcome, options.out)) {
    result.json["files"].push_back(file.string());
    result.text += (result.json["files"].size() > 1 ? "\n" : "") + file.string();
  }
  return result;
}

void AddLength(CLI::App& command, const std::string& option, std::optional<double>* mm,
               const std::string& what) {
  command.add_option(option, *mm, what)->check(PositiveLength());
}

}  // namespace

void AddCoverageCommand(CLI::App& app, Choice* choice) {
  CLI::App* command = app.add_subcommand(
      "coverage", "what a rig can do at each place of the workspace, and where another camera would help");
  auto options = std::make_shared<CoverageCommandOptions>();
  command->add_option("RIG", options->request.rig_file, "rig (RIG.yml)")->required();
  AddLength(*command, "--grid", &options->request.grid_mm,
            "distance of the places that are looked at, mm (default: 20, by the workspace's size)");
  command->add_option("--layout", options->request.layout,
                      "also the space near the parts of this layout (TOML)");
  command
      ->add_option("--near", options->request.near_mm,
                   "how far from a part's surface is near it, mm (default: 100)")
      ->check(PositiveLength());
  AddLength(*command, "--ball", &options->request.ball_mm,
            "diameter of the ball whose phantom volume is worked out, mm (default: 50)");
  command
      ->add_option("--ceiling", options->request.ceiling_mm,
                   "propose no camera above this height (z in world), mm")
      ->check(CLI::Validator(
          [](const std::string& text) -> std::string {
            return ParseNumber(text) ? "" : "must be a number, not " + text;
          },
          "MM"));
  command->add_flag("!--no-next", options->request.tries_cameras,
                    "don't look for a place for another camera");
  command
      ->add_option("--out", options->out,
                   "folder for coverage.html, the pictures (SVG) and coverage.glb; made if needed")
      ->required();
  command->callback(
      [=] { choice->action = [=](const CommandContext& context) { return Run(*options, context); }; });
}

}  // namespace elbowroom::cli
