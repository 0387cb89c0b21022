// elbowroom sweep S.db... --spacing NAME=FROM:TO:STEP_MM --out DIR: how much space recorded motion needs.
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <iterator>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "app/cli/options/command.h"
#include "app/cli/options/value_json.h"
#include "app/cli/recorded/revision_options.h"
#include "app/cli/recorded/sweep_options.h"
#include "app/control/revisions/revision_files.h"
#include "app/control/revisions/revision_touches.h"
#include "app/control/sweep/spacing_sweep.h"
#include "app/control/sweep/sweep_files.h"

namespace elbowroom::cli {
namespace {

struct SweepOptions {
  control::SweepRequest request;
  std::vector<RevisionSetting> revisions;
  control::SweepEngine engine = control::SweepEngine::kLocal;
  bool cells_only = false;
};

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

nlohmann::json StepsJson(const control::SpacingSweep& sweep, const review::SpacingCurve& curve) {
  nlohmann::json steps = nlohmann::json::array();
  for (const review::StudyStep& step : curve.steps) {
    nlohmann::json parts = nlohmann::json::array();
    for (core::PartIndex i = 0; i < step.parts.size(); ++i)
      parts.push_back(PartJson(step.parts[i], sweep.parts[i]));
    steps.push_back({{"spacing_mm", step.spacing_mm}, {"parts", parts}});
  }
  return steps;
}

nlohmann::json CurveJson(const control::SpacingSweep& sweep, const review::SpacingCurve& curve,
                         const std::optional<double>& with_clearance_mm) {
  return {{"frames", curve.frames},
          {"largest_touched_mm", OrNull(curve.largest_touched_mm)},
          {"smallest_free_mm", OrNull(curve.smallest_free_mm)},
          {"smallest_with_clearance_mm", OrNull(with_clearance_mm)},
          {"steps", StepsJson(sweep, curve)}};
}

// `session`: null for all of them.
nlohmann::json CurvesJson(const control::SpacingSweep& sweep, const control::SweptCurves& curves,
                          const control::SweptSession* session) {
  const auto json_of = [&](const review::SpacingCurve& curve) {
    return CurveJson(sweep, curve,
                     session != nullptr ? control::SmallestWithClearanceMm(sweep, *session, curve)
                                        : control::SmallestWithClearanceMm(sweep, curve));
  };
  nlohmann::json json = json_of(curves.all);
  json["tools"] = nlohmann::json::array();
  const auto add = [&](const nlohmann::json& tool, const review::SpacingCurve& curve) {
    nlohmann::json of_tool = json_of(curve);
    of_tool["tool"] = tool;
    json["tools"].push_back(std::move(of_tool));
  };
  add(nullptr, curves.without_tools);
  for (const auto& [tool, curve] : curves.with_tool) add(tool, curve);
  return json;
}

nlohmann::json SessionJson(const control::SpacingSweep& sweep, const control::SweptSession& session) {
  nlohmann::json json = CurvesJson(sweep, session.curves, &session);
  json["session"] = session.path.string();
  json["recording_id"] = session.recording_id;
  json["participant"] = session.participant;
  json["estimate_mm"] = session.estimate_mm > 0.0 ? nlohmann::json(session.estimate_mm) : nlohmann::json();
  json["required_clearance_mm"] = session.required_clearance_mm;
  json["frames_without_camera"] = session.frames_without_camera;
  return json;
}

// The keys of all sessions' curve stand at the top, as those of a single session's.
// `touching`: at each step, how many sessions' motion touches what the revision changes.
nlohmann::json RevisionsJson(const control::SpacingSweep& sweep) {
  const std::vector<control::RevisionTouches> touches = control::TouchesOfRevisions(sweep);
  nlohmann::json revisions = nlohmann::json::array();
  for (std::size_t k = 0; k < touches.size(); ++k) {
    const control::SweptRevision& revision = sweep.revisions[k];
    nlohmann::json json = {{"revision", revision.name},
                           {"touching", touches[k].touching},
                           {"touching_before", touches[k].touching_before},
                           {"largest_touched_mm", OrNull(revision.all.all.largest_touched_mm)},
                           {"smallest_free_mm", OrNull(revision.all.all.smallest_free_mm)}};
    json["changed"] = nlohmann::json::array();
    for (const core::PartIndex part : revision.changed) json["changed"].push_back(revision.parts[part]);
    json["sessions"] = nlohmann::json::array();
    for (std::size_t i = 0; i < sweep.sessions.size(); ++i) {
      nlohmann::json frames = nlohmann::json::array(), deepest_mm = nlohmann::json::array();
      for (const control::RevisionTouch& touch : touches[k].by_session[i]) {
        frames.push_back(touch.frames_in_contact);
        deepest_mm.push_back(touch.deepest_mm);
      }
      json["sessions"].push_back({{"session", sweep.sessions[i].path.string()},
                                  {"frames_in_contact", std::move(frames)},
                                  {"deepest_mm", std::move(deepest_mm)}});
    }
    revisions.push_back(std::move(json));
  }
  return revisions;
}

nlohmann::json SweepJson(const SweepOptions& options, const control::SpacingSweep& sweep) {
  nlohmann::json all = CurvesJson(sweep, sweep.all, nullptr), json = all;
  json["all"] = std::move(all);
  json["spacing"] = options.request.range.spacing;
  json["moved"] = nlohmann::json::array();
  for (const core::PartIndex part : sweep.moved) json["moved"].push_back(sweep.parts[part]);
  json["sessions"] = nlohmann::json::array();
  std::int64_t without_camera = 0;
  for (const control::SweptSession& session : sweep.sessions) {
    json["sessions"].push_back(SessionJson(sweep, session));
    without_camera += session.frames_without_camera;
  }
  json["frames_without_camera"] = without_camera;
  json["asked"] = sweep.count.asked;
  json["settled_by_motion"] = sweep.count.settled_by_motion;
  json["unmoved"] = sweep.count.unmoved;
  json["unchanged_frames"] = sweep.count.unchanged_frames;
  json["queries"] = sweep.count.queries;
  json["revisions"] = RevisionsJson(sweep);
  json["hulls"] = sweep.hulls;
  json["hulls_kept"] = sweep.hulls_kept;
  json["cells"] = sweep.cells;
  json["cells_from_before"] = sweep.cells_from_before;
  json["engine"] = control::ToString(options.engine);
  return json;
}

std::string TextOf(const std::string& spacing, const control::SpacingSweep& sweep,
                   const review::SpacingCurve& curve) {
  if (sweep.moved.empty()) return fmt::format("'{}' moves no part", spacing);
  std::string text;
  if (!curve.smallest_free_mm)
    text = fmt::format("'{}': touched at {:.1f} mm; no spacing tried above it is free of contact", spacing,
                       curve.largest_touched_mm.value_or(curve.steps.back().spacing_mm));
  else if (!curve.largest_touched_mm)
    text = fmt::format("'{}': free of contact from {:.1f} mm on, the smallest tried", spacing,
                       *curve.smallest_free_mm);
  else
    text = fmt::format("'{}': touched at {:.2f} mm, free of contact from {:.2f} mm on", spacing,
                       *curve.largest_touched_mm, *curve.smallest_free_mm);
  if (const auto clear_mm = control::SmallestWithClearanceMm(sweep, curve))
    text += fmt::format("; the required clearance is sure from {:.6g} mm on", *clear_mm);
  return text;
}

std::string TextOf(const std::string& spacing, const control::SpacingSweep& sweep) {
  std::string text = TextOf(spacing, sweep, sweep.all.all);
  if (sweep.sessions.size() > 1) {
    text = fmt::format("{} sessions: {}", sweep.sessions.size(), text);
    for (const control::SweptSession& session : sweep.sessions)
      text += fmt::format("\n{}: {}", session.path.string(), TextOf(spacing, sweep, session.curves.all));
  }
  const std::vector<control::RevisionTouches> touches = control::TouchesOfRevisions(sweep);
  for (std::size_t k = 0; k < touches.size(); ++k)
    text += fmt::format(
        "\nrevision '{}': what it changes is touched by {} of {} recorded motions at the smallest gap, by {} "
        "at the "
        "largest",
        sweep.revisions[k].name, touches[k].touching.front(), sweep.sessions.size(),
        touches[k].touching.back());
  if (sweep.all.with_tool.empty()) return text;
  text += "\nwithout a tool: " + TextOf(spacing, sweep, sweep.all.without_tools);
  for (const auto& [tool, curve] : sweep.all.with_tool)
    text += fmt::format("\nwith {}: {}", tool, TextOf(spacing, sweep, curve));
  return text;
}

CommandResult Run(const SweepOptions& options, const CommandContext& context) {
  control::SweepRequest request = options.request;
  CommandResult result;
  std::vector<std::string> warnings;
  request.revisions = SweepRevisionsOf(options.revisions, context, &warnings);
  result.hint = RunEngine(options.engine, &request, context);
  const control::SpacingSweep sweep = control::SweepSpacing(request, context.progress, context.stop);
  result.json = SweepJson(options, sweep);
  result.json["warnings"] = warnings;
  result.text = TextOf(request.range.spacing, sweep);
  if (sweep.cells_from_before > 0)
    result.text +=
        fmt::format("\n{} of {} cells were kept from before", sweep.cells_from_before, sweep.cells);
  result.json["files"] = nlohmann::json::array();
  for (const std::string& warning : warnings) result.text += "\nwarning: " + warning;
  if (options.cells_only) return result;
  std::vector<std::filesystem::path> files = control::WriteSpacingSweep(request.range, sweep, request.folder);
  if (!sweep.revisions.empty())
    std::ranges::move(
        control::WriteRevisions(request.range, sweep, request.folder, context.progress, context.stop),
        std::back_inserter(files));
  for (const std::filesystem::path& file : files) {
    result.json["files"].push_back(file.string());
    result.text += "\n" + file.string();
  }
  return result;
}

}  // namespace

void AddSweepCommand(CLI::App& app, Choice* choice) {
  CLI::App* command =
      app.add_subcommand("sweep", "space needed: contacts and clearance of sessions over a spacing");
  auto options = std::make_shared<SweepOptions>();
  command->add_option("SESSION", options->request.sessions, "the sessions (S.db), of one layout")->required();
  command
      ->add_option_function<std::string>(
          "--spacing",
          [options](const std::string& text) { options->request.range = *ParseSpacingRange(text); },
          "the gap to sweep, and its values in mm")
      ->required()
      ->check(CLI::Validator(
          [](const std::string& text) -> std::string {
            return ParseSpacingRange(text)
                       ? ""
                       : "must be NAME=FROM:TO:STEP in mm, FROM no larger than TO, not " + text;
          },
          "NAME=FROM:TO:STEP_MM"));
  command
      ->add_option("--out", options->request.folder,
                   "folder for sweep.csv, sweep.svg, sweep.png; made if needed. What is done is kept in its "
                   "cells, so that a sweep that was ended early goes on")
      ->required();
  AddRevisionOption(*command, &options->revisions);
  AddEngineOption(*command, &options->engine);
  command->add_flag(
      "--keep-hulls", options->request.keeps_hulls,
      "keep the hulls, too, so that changed CAD needs none of them again: about as many bytes a "
      "frame as docs/scale.md says");
  command->add_flag("--cells-only", options->cells_only,
                    "keep the cells, write no files: for an engine's jobs");
  command->callback(
      [=] { choice->action = [=](const CommandContext& context) { return Run(*options, context); }; });
}

}  // namespace elbowroom::cli
