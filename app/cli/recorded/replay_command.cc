// elbowroom replay S.db --session NEW.db: the recorded motion judged again, as it was or with changes.
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/cli/options/command.h"
#include "app/cli/options/frame_range_option.h"
#include "app/cli/options/spacing_option.h"
#include "app/cli/recorded/revision_options.h"
#include "app/control/outcome_tracker.h"
#include "app/control/replay/replay.h"
#include "cad_import/layout/layout_file.h"

namespace elbowroom::cli {
namespace {

struct ReplayCommandOptions {
  std::filesystem::path recorded;
  std::filesystem::path layout;
  std::vector<SpacingSetting> spacings;
  std::vector<PartSetting> parts;
  bool segments = false;
  control::SegmentingOptions segmenting;
  control::ReplayOptions replay;
};

control::ReplayChanges ChangesOf(const ReplayCommandOptions& options, const CommandContext& context,
                                 std::vector<std::string>* warnings) {
  control::ReplayChanges changes;
  if (!options.layout.empty()) {
    cad_import::ImportedLayout imported =
        cad_import::ImportLayoutFile(options.layout, context.progress, context.stop);
    changes.layout = std::move(imported.layout);
    *warnings = std::move(imported.warnings);
  }
  for (const PartSetting& part : options.parts)
    changes.parts.push_back(PartRevisionOf(part, context, warnings));
  for (const SpacingSetting& spacing : options.spacings) changes.held_mm[spacing.name] = spacing.gap_mm;
  return changes;
}

nlohmann::json ComparisonJson(const std::optional<control::ReplayComparison>& compared) {
  if (!compared) return nullptr;
  return {{"frames", compared->frames},
          {"rows", compared->rows},
          {"frames_that_differ", compared->frames_that_differ},
          {"first_that_differs",
           compared->first_that_differs ? nlohmann::json(*compared->first_that_differs) : nlohmann::json()}};
}

nlohmann::json SkippedJson(const control::SkipCount& skipped) {
  return {{"unchanged_silhouettes", skipped.hull.unchanged_silhouettes},
          {"unchanged_parts", skipped.unchanged_parts},
          {"triangles", skipped.triangles_skipped},
          {"of_triangles", skipped.triangles_in_all},
          {"queries", skipped.queries},
          {"clearances_by_contact", skipped.clearances_by_contact},
          {"clearances_by_ball", skipped.clearances_by_ball},
          {"clearance_queries", skipped.clearance_queries}};
}

nlohmann::json SegmentedJson(const std::optional<control::ReplaySegmented>& segmented) {
  if (!segmented) return nullptr;
  return {{"footage", segmented->footage.string()},
          {"pictures", segmented->count.pictures},
          {"missing_pictures", segmented->count.missing},
          {"silhouettes_that_differ", segmented->count.silhouettes_that_differ}};
}

nlohmann::json ReplayJson(const ReplayCommandOptions& options, const control::ReplayOutcome& outcome) {
  const bool is_compared = outcome.compared.has_value();
  nlohmann::json absent = nlohmann::json::array();
  for (const core::Finding& finding : outcome.absent)
    absent.push_back({{"id", finding.id},
                      {"kind", core::ToString(finding.kind)},
                      {"part", finding.part},
                      {"presence", core::ToString(finding.presence)}});
  return {{"session", options.replay.session.string()},
          {"replay_of", options.recorded.string()},
          {"frames", outcome.frames},
          {"touches", outcome.outcome.episodes.size()},
          {"near_misses", outcome.outcome.near_misses.size()},
          {"contact_rows", outcome.contact_rows},
          {"changes", outcome.changes},
          {"identical",
           is_compared ? nlohmann::json(outcome.compared->frames_that_differ == 0) : nlohmann::json()},
          {"compared", ComparisonJson(outcome.compared)},
          {"segmented", SegmentedJson(outcome.segmented)},
          {"absent", absent},
          {"skipped", SkippedJson(outcome.skipped)},
          {"time_ms", outcome.time_s * 1000.0},
          {"frame_ms", outcome.time_s * 1000.0 / static_cast<double>(outcome.frames)}};
}

std::string ReplayText(const ReplayCommandOptions& options, const control::ReplayOutcome& outcome) {
  std::string text =
      fmt::format("{}: {} frames replayed in {:.2f} s ({:.2f} ms a frame), {} touches, {} near misses",
                  options.replay.session.string(), outcome.frames, outcome.time_s,
                  outcome.time_s * 1000.0 / static_cast<double>(outcome.frames),
                  outcome.outcome.episodes.size(), outcome.outcome.near_misses.size());
  for (const std::string& change : outcome.changes) text += "\n  changed: " + change;
  if (const auto& segmented = outcome.segmented) {
    text += fmt::format(
        "\n  segmented again: {} pictures of '{}'; {} silhouettes differ from the recorded ones",
        segmented->count.pictures, segmented->footage.string(), segmented->count.silhouettes_that_differ);
    if (segmented->count.missing > 0)
      text +=
          fmt::format("\n  {} pictures that were judged aren't in the footage; their frames lack that camera",
                      segmented->count.missing);
  }
  if (const auto& compared = outcome.compared) {
    text += compared->frames_that_differ == 0
                ? fmt::format("\n  identical: all {} rows are those of the recording", compared->rows)
                : fmt::format("\n  not identical: {} of {} frames differ, the first is {}",
                              compared->frames_that_differ, compared->frames, *compared->first_that_differs);
  }
  for (const core::Finding& finding : outcome.absent)
    text += fmt::format("\n  {}: {} on '{}' at {:.2f} s ({})", core::ToString(finding.presence),
                        core::ToString(finding.kind), finding.part, finding.begin_s, finding.id.substr(0, 8));
  return text;
}

CommandResult Run(const ReplayCommandOptions& options, const CommandContext& context) {
  const sessions::SessionReader recorded =
      control::OpenWithOutcome(options.recorded, context.progress, context.stop);
  control::ReplayOptions replay = options.replay;
  std::vector<std::string> warnings;
  replay.changes = ChangesOf(options, context, &warnings);
  if (options.segments) replay.segmenting = options.segmenting;
  const control::ReplayOutcome outcome = control::RunReplay(recorded, replay, context.progress, context.stop);
  if (outcome.segmented)
    warnings.insert(warnings.end(), outcome.segmented->warnings.begin(), outcome.segmented->warnings.end());
  CommandResult result{ReplayJson(options, outcome), ReplayText(options, outcome)};
  result.json["warnings"] = warnings;
  for (const std::string& warning : warnings) result.text += "\nwarning: " + warning;
  return result;
}

void AddSegmentOptions(CLI::App& command, ReplayCommandOptions* options) {
  CLI::Option* segment = command.add_flag(
      "--segment", options->segments,
      "segment the footage's pictures again, with the recorded settings unless others are given");
  command
      .add_option(
          "--segmentation", options->segmenting.settings,
          "with --segment: the settings are those of [segmentation] in this file, such as a TRIAL.toml")
      ->needs(segment);
  command
      .add_option(
          "--rig", options->segmenting.rig,
          "with --segment: the backgrounds are those that this RIG.yml names; of a session that names no "
          "footage, the pictures, too")
      ->needs(segment);
}

}  // namespace

void AddReplayCommand(CLI::App& app, Choice* choice) {
  CLI::App* command =
      app.add_subcommand("replay", "judge a session's motion again, with other gaps, parts or thresholds");
  auto options = std::make_shared<ReplayCommandOptions>();
  command->add_option("SESSION", options->recorded, "the recorded session (S.db)")->required();
  command->add_option("--session", options->replay.session, "the new session; must not exist yet")
      ->required();
  AddSpacingOption(*command, &options->spacings);
  command->add_option("--layout", options->layout,
                      "another layout (LAYOUT.toml); names say which part is which");
  command
      ->add_option_function<std::vector<std::string>>(
          "--part",
          [options](const std::vector<std::string>& texts) {
            for (const std::string& text : texts) options->parts.push_back(*ParsePart(text));
          },
          "another revision of a part's CAD, in its place; may be given several times")
      ->type_name("NAME=FILE[:UNIT]")
      ->check([](const std::string& text) {
        return ParsePart(text) ? std::string() : "must be NAME=FILE or NAME=FILE:UNIT, not " + text;
      });
  AddFrameRangeOption(*command, &options->replay.frames);
  AddSegmentOptions(*command, options.get());
  command->callback(
      [=] { choice->action = [=](const CommandContext& context) { return Run(*options, context); }; });
}

}  // namespace elbowroom::cli
