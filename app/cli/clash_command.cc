// elbowroom clash LAYOUT.toml: parts against parts, where the layout has them.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <tuple>

#include "app/cli/options/command.h"
#include "app/cli/options/spacing_option.h"
#include "app/cli/options/unit_option.h"
#include "app/cli/options/value_json.h"
#include "app/cli/repeated_timing.h"
#include "cad_import/layout/layout_file.h"
#include "review/clash.h"

namespace elbowroom::cli {
namespace {

using core::Verdict;
using review::PairClash;

struct ClashCommandOptions {
  std::filesystem::path layout_file;
  std::vector<SpacingSetting> spacings;
  review::PairSelection selection;
  double required_mm = 0.0;
  double uncertainty_mm = 0.0;
};

// The order in which pairs are listed, small numbers first. Authorised contacts come just before pairs that
// are clear.
int Urgency(const PairClash& pair) {
  if (pair.demand.authorised_contact && pair.verdict != Verdict::kClear) return 3;
  switch (pair.verdict) {
    case Verdict::kContact:
      return 0;
    case Verdict::kNear:
      return 1;
    case Verdict::kUndecided:
      return 2;
    case Verdict::kClear:
      break;
  }
  return 4;
}

std::vector<PairClash> WorstFirst(std::vector<PairClash> pairs) {
  const auto key = [](const PairClash& pair) {
    return std::tuple(Urgency(pair), !pair.gap, pair.at_least_mm - pair.demand.required_mm);
  };
  std::stable_sort(pairs.begin(), pairs.end(),
                   [&](const PairClash& one, const PairClash& other) { return key(one) < key(other); });
  return pairs;
}

nlohmann::json Json(const PairClash& pair, const core::Layout& layout) {
  nlohmann::json json = {{"a", layout.parts[pair.demand.a].name},
                         {"b", layout.parts[pair.demand.b].name},
                         {"verdict", ToString(pair.verdict)},
                         {"distance_mm", nullptr},
                         {"at_least_mm", pair.at_least_mm},
                         {"required_mm", pair.demand.required_mm},
                         {"uncertainty_mm", pair.uncertainty_mm},
                         {"deviation_mm", pair.deviation_mm},
                         {"witness_a_mm", nullptr},
                         {"witness_b_mm", nullptr},
                         {"contained", pair.contained},
                         {"authorised", pair.demand.authorised_contact}};
  if (pair.gap) {
    json["distance_mm"] = pair.gap->distance_mm;
    json["witness_a_mm"] = JsonOf(pair.gap->on_a);
    json["witness_b_mm"] = JsonOf(pair.gap->on_b);
  }
  return json;
}

std::string Line(const PairClash& pair, const core::Layout& layout) {
  const Eigen::Vector3d& at = pair.gap->on_a;
  return fmt::format(
      "\n{:<10}{:>14.3f}{:>14.3f}  {:<32}  {}, {}{}{}", ToString(pair.verdict), pair.gap->distance_mm,
      pair.demand.required_mm, fmt::format("{:.3f} {:.3f} {:.3f}", at.x(), at.y(), at.z()),
      layout.parts[pair.demand.a].name, layout.parts[pair.demand.b].name,
      pair.contained ? " (one inside the other)" : "", pair.demand.authorised_contact ? " (authorised)" : "");
}

struct Tally {
  std::int64_t contacts = 0;
  std::int64_t authorised_contacts = 0;
  std::int64_t near = 0;
  std::int64_t clear = 0;
  std::int64_t undecided = 0;
};

Tally Count(const std::vector<PairClash>& pairs) {
  const auto count = [&](Verdict verdict) {
    return std::count_if(pairs.begin(), pairs.end(),
                         [&](const PairClash& pair) { return pair.verdict == verdict; });
  };
  return {count(Verdict::kContact),
          std::count_if(pairs.begin(), pairs.end(),
                        [](const PairClash& pair) {
                          return pair.verdict == Verdict::kContact && pair.demand.authorised_contact;
                        }),
          count(Verdict::kNear), count(Verdict::kClear), count(Verdict::kUndecided)};
}

CommandResult ResultOf(const review::ClashReport& report, const core::Layout& layout, std::int64_t ignored) {
  const Tally tally = Count(report.pairs);
  const review::ClashCount& count = report.count;
  CommandResult result;
  result.json = {{"pairs", count.pairs},
                 {"contacts", tally.contacts},
                 {"authorised_contacts", tally.authorised_contacts},
                 {"near", tally.near},
                 {"undecided", tally.undecided},
                 {"clear", tally.clear},
                 {"ignored", ignored},
                 {"settled_by_bounds", count.settled_by_bounds},
                 {"fcl_calls", count.collision_calls + count.distance_calls},
                 {"fcl_collision_calls", count.collision_calls},
                 {"fcl_distance_calls", count.distance_calls},
                 {"results", nlohmann::json::array()}};
  result.text = fmt::format("{:<10}{:>14}{:>14}  {:<32}  {}", "verdict", "distance, mm", "required, mm",
                            "on the first, mm in world", "parts");
  for (const PairClash& pair : WorstFirst(report.pairs)) {
    result.json["results"].push_back(Json(pair, layout));
    if (pair.gap) result.text += Line(pair, layout);
  }
  result.text += fmt::format(
      "\n{} pairs: {} in contact ({} of them authorised), {} near, {} undecided, {} clear ({} by their "
      "bounds "
      "alone); {} ignored; FCL was asked {} times",
      count.pairs, tally.contacts, tally.authorised_contacts, tally.near, tally.undecided, tally.clear,
      count.settled_by_bounds, ignored, count.collision_calls + count.distance_calls);
  return result;
}

CommandResult Run(const ClashCommandOptions& options, const CommandContext& context, bool json) {
  const cad_import::ImportedLayout imported =
      cad_import::ImportLayoutFile(options.layout_file, context.progress, context.stop);
  const core::Layout layout = core::WithPairsOfParts(imported.layout);
  const review::PairMatrix matrix = review::PairsOf(layout, options.selection, options.required_mm);
  const std::vector<core::RigidTransform> world_from_parts =
      core::PosesAt(layout, SpacingsWith(layout, options.spacings));
  const std::vector<double> uncertainty_mm(layout.parts.size(), options.uncertainty_mm);
  review::ClashReport report;
  const auto compute = [&] {
    review::ClashChecker checker(layout, matrix.pairs, uncertainty_mm);
    report = checker.Check(world_from_parts, context.progress, context.stop);
  };
  const RunTimes times = ComputeAndTime(json, compute);
  CommandResult result = ResultOf(report, layout, matrix.ignored);
  AddTimes(times, &result.json);
  result.json["warnings"] = imported.warnings;
  for (const std::string& warning : imported.warnings) result.text += "\nwarning: " + warning;
  return result;
}

void AddNames(CLI::App& command, const std::string& option, std::vector<std::string>* names,
              const std::string& what) {
  command.add_option(option, *names, what)->delimiter(',')->allow_extra_args(false)->type_name("NAME,...");
}

}  // namespace

void AddClashCommand(CLI::App& app, Choice* choice) {
  CLI::App* command = app.add_subcommand("clash", "which parts of a layout touch, or come too near");
  auto options = std::make_shared<ClashCommandOptions>();
  command->add_option("LAYOUT", options->layout_file, "layout (TOML)")->required();
  AddSpacingOption(*command, &options->spacings);
  AddNames(*command, "--within", &options->selection.within,
           "only pairs of which both parts are among these");
  AddNames(*command, "--between", &options->selection.between, "only pairs of one of these parts ...");
  AddNames(*command, "--and", &options->selection.and_these, "... and one of these");
  command
      ->add_option("--required", options->required_mm,
                   "clearance of pairs without a [[pair]], mm (default: 0)")
      ->check(LengthFromZero());
  command
      ->add_option("--uncertainty", options->uncertainty_mm,
                   "how far a part's true surface may lie from its mesh, mm (default: 0)")
      ->check(LengthFromZero());
  command->callback([=, &app] {
    const bool json = app.get_option("--json")->as<bool>();
    choice->action = [=](const CommandContext& context) { return Run(*options, context, json); };
  });
}

}  // namespace elbowroom::cli
