// elbowroom sweep S.db --spacing NAME=FROM:TO:STEP_MM --out DIR: how much space the recorded motion needs.
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <optional>

#include "app/cli/options/command.h"
#include "app/cli/options/unit_option.h"
#include "app/cli/options/value_json.h"
#include "app/control/sweep/spacing_sweep.h"

namespace elbowroom::cli {
namespace {

struct SweepOptions {
  std::filesystem::path session;
  std::filesystem::path out;
  control::SpacingRange range;
};

// NAME=FROM:TO:STEP
std::optional<control::SpacingRange> ParseSpacingRange(const std::string& text) {
  const std::size_t equals = text.rfind('='),
                    first = text.find(':', equals == std::string::npos ? 0 : equals),
                    second = first == std::string::npos ? first : text.find(':', first + 1);
  if (equals == std::string::npos || equals == 0 || second == std::string::npos) return std::nullopt;
  const auto from_mm = ParseNumber(text.substr(equals + 1, first - equals - 1)),
             to_mm = ParseNumber(text.substr(first + 1, second - first - 1)),
             step_mm = ParseNumber(text.substr(second + 1));
  if (!from_mm || !to_mm || !step_mm || !(*step_mm > 0.0) || *to_mm < *from_mm) return std::nullopt;
  return control::SpacingRange{text.substr(0, equals), *from_mm, *to_mm, *step_mm};
}

nlohmann::json PartJson(const review::PartAtSpacing& part, const std::string& name) {
  return {{"part", name},
          {"frames_in_contact", part.frames_in_contact},
          {"frames_near", part.frames_near},
          {"frames_undecided", part.frames_undecided},
          {"frames_clear", part.frames_clear},
          {"deepest_mm", part.deepest_mm},
          {"lower_mm", OrNull(part.lower_mm)},
          {"upper_mm", OrNull(part.upper_mm)},
          {"closest_frame", part.closest_frame ? nlohmann::json(*part.closest_frame) : nlohmann::json()}};
}

nlohmann::json StudyJson(const core::Layout& layout, const std::string& spacing,
                         const review::SpacingStudy& study) {
  nlohmann::json json = {{"spacing", spacing},
                         {"moved", nlohmann::json::array()},
                         {"largest_touched_mm", OrNull(study.largest_touched_mm)},
                         {"smallest_free_mm", OrNull(study.smallest_free_mm)},
                         {"steps", nlohmann::json::array()},
                         {"asked", study.count.asked},
                         {"settled_by_motion", study.count.settled_by_motion},
                         {"unmoved", study.count.unmoved},
                         {"queries", study.count.queries}};
  for (const core::PartIndex part : study.moved) json["moved"].push_back(layout.parts[part].name);
  for (const review::StudyStep& step : study.steps) {
    nlohmann::json parts = nlohmann::json::array();
    for (core::PartIndex i = 0; i < step.parts.size(); ++i)
      parts.push_back(PartJson(step.parts[i], layout.parts[i].name));
    json["steps"].push_back({{"spacing_mm", step.spacing_mm}, {"parts", parts}});
  }
  return json;
}

std::string TextOf(const std::string& spacing, const review::SpacingStudy& study) {
  if (study.moved.empty()) return fmt::format("'{}' moves no part", spacing);
  if (!study.smallest_free_mm)
    return fmt::format("'{}': touched at {:.1f} mm; no spacing tried above it is free of contact", spacing,
                       study.largest_touched_mm.value_or(study.steps.back().spacing_mm));
  if (!study.largest_touched_mm)
    return fmt::format("'{}': free of contact from {:.1f} mm on, the smallest tried", spacing,
                       *study.smallest_free_mm);
  return fmt::format("'{}': touched at {:.2f} mm, free of contact from {:.2f} mm on", spacing,
                     *study.largest_touched_mm, *study.smallest_free_mm);
}

CommandResult Run(const SweepOptions& options, const CommandContext& context) {
  const sessions::SessionReader session(options.session, context.stop);
  const review::SpacingStudy study =
      control::SweepSpacing(session, options.range, context.progress, context.stop);
  CommandResult result;
  result.json = StudyJson(session.header().layout, options.range.spacing, study);
  result.text = TextOf(options.range.spacing, study);
  result.json["files"] = nlohmann::json::array();
  for (const auto& file : control::WriteSpacingSweep(session.header(), options.range, study, options.out)) {
    result.json["files"].push_back(file.string());
    result.text += "\n" + file.string();
  }
  return result;
}

}  // namespace

void AddSweepCommand(CLI::App& app, Choice* choice) {
  CLI::App* command =
      app.add_subcommand("sweep", "space needed: contacts and clearance of a session over a spacing");
  auto options = std::make_shared<SweepOptions>();
  command->add_option("SESSION", options->session, "the session (S.db)")->required();
  command
      ->add_option_function<std::string>(
          "--spacing", [options](const std::string& text) { options->range = *ParseSpacingRange(text); },
          "the gap to sweep, and its values in mm")
      ->required()
      ->check(CLI::Validator(
          [](const std::string& text) -> std::string {
            return ParseSpacingRange(text)
                       ? ""
                       : "must be NAME=FROM:TO:STEP in mm, FROM no larger than TO, not " + text;
          },
          "NAME=FROM:TO:STEP_MM"));
  command->add_option("--out", options->out, "folder for sweep.csv, sweep.svg, sweep.png; made if needed")
      ->required();
  command->callback(
      [=] { choice->action = [=](const CommandContext& context) { return Run(*options, context); }; });
}

}  // namespace elbowroom::cli
