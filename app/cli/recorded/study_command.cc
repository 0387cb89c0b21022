// elbowroom study S.db... --out DIR: participants' estimates against what was needed, and conditions
// compared.
#include <fmt/format.h>

#include <memory>
#include <optional>
#include <utility>

#include "app/cli/options/command.h"
#include "app/cli/options/value_json.h"
#include "app/cli/recorded/sweep_options.h"
#include "app/control/study/study.h"
#include "app/control/study/study_block.h"
#include "app/control/study/study_files.h"
#include "app/control/study/study_text.h"

namespace elbowroom::cli {
namespace {

struct StudyOptions {
  control::SweepRequest request;  // its range: where --spacing gives one
  bool has_range = false;
  std::string baseline;  // empty: none
  std::string block;     // empty: all sessions
  control::SweepEngine engine = control::SweepEngine::kLocal;
};

nlohmann::json RowJson(const control::StudyRow& row) {
  return {{"participant", row.participant},
          {"sessions", row.sessions},
          {"estimate_before_mm", OrNull(row.estimate_before_mm)},
          {"needed_without_tools_mm", OrNull(row.needed_without_tools_mm)},
          {"needed_mm", OrNull(row.needed_mm)},
          {"shortfall_mm", OrNull(row.shortfall_mm())},
          {"estimate_after_mm", OrNull(row.estimate_after_mm)}};
}

nlohmann::json IntervalJson(const std::optional<core::Interval>& interval) {
  if (!interval) return nullptr;
  return {interval->lower, interval->upper};
}

template <typename Result>
nlohmann::json Of(const std::optional<Result>& result, double Result::*value) {
  return result ? nlohmann::json((*result).*value) : nlohmann::json();
}

nlohmann::json ComparisonJson(const control::Comparison& comparison) {
  using core::MeanComparison;
  return {{"measure", comparison.measure},
          {"a", comparison.a},
          {"b", comparison.b},
          {"n_a", comparison.of_a.n},
          {"n_b", comparison.of_b.n},
          {"mean_a", comparison.of_a.mean},
          {"mean_b", comparison.of_b.mean},
          {"sd_a", OrNull(comparison.of_a.sd)},
          {"sd_b", OrNull(comparison.of_b.sd)},
          {"t", Of(comparison.means, &MeanComparison::t)},
          {"df", Of(comparison.means, &MeanComparison::df)},
          {"p", Of(comparison.means, &MeanComparison::p)},
          {"corrected_p", OrNull(comparison.corrected_p)},
          {"effect_size", OrNull(comparison.effect_size)},
          {"u", Of(comparison.ranks, &core::RankSumTest::u)},
          {"p_ranks", Of(comparison.ranks, &core::RankSumTest::p)},
          {"in_both", comparison.in_both},
          {"t_pairs", Of(comparison.pairs, &MeanComparison::t)},
          {"df_pairs", Of(comparison.pairs, &MeanComparison::df)},
          {"p_pairs", Of(comparison.pairs, &MeanComparison::p)},
          {"decisive_p", OrNull(comparison.decisive_p)}};
}

nlohmann::json StudyJson(const control::Study& study) {
  nlohmann::json json = {
      {"spacing", study.range.spacing},
      {"from_mm", study.range.from_mm},
      {"to_mm", study.range.to_mm},
      {"step_mm", study.range.step_mm},
      {"sessions", study.sessions.size()},
      {"participants", study.rows.size()},
      {"mean_shortfall_mm", study.shortfall_mm ? nlohmann::json(study.shortfall_mm->mean) : nlohmann::json()},
      {"sd_shortfall_mm", study.shortfall_mm ? OrNull(study.shortfall_mm->sd) : nlohmann::json()},
      {"shortfall_interval_mm", IntervalJson(study.shortfall_interval_mm)},
      {"shortfall_bootstrap_mm", IntervalJson(study.shortfall_bootstrap_mm)},
      {"confidence", control::kConfidence},
      {"baseline", study.baseline.empty() ? nlohmann::json() : nlohmann::json(study.baseline)},
      {"notes", study.notes},
      {"cells", study.sweep.cells},
      {"cells_from_before", study.sweep.cells_from_before}};
  json["rows"] = nlohmann::json::array();
  for (const control::StudyRow& row : study.rows) json["rows"].push_back(RowJson(row));
  json["beyond_baseline"] = nlohmann::json::array();
  for (const control::BeyondBaseline& row : study.beyond)
    json["beyond_baseline"].push_back({{"participant", row.participant},
                                       {"condition", row.condition},
                                       {"measure", row.measure},
                                       {"value", row.value},
                                       {"baseline", row.baseline},
                                       {"difference", row.difference()}});
  json["comparisons"] = nlohmann::json::array();
  for (const control::Comparison& comparison : study.comparisons)
    json["comparisons"].push_back(ComparisonJson(comparison));
  json["correlations"] = nlohmann::json::array();
  for (const control::MeasuresCorrelated& pair : study.correlations)
    json["correlations"].push_back({{"a", pair.a},
                                    {"b", pair.b},
                                    {"n", pair.correlation.n},
                                    {"r", pair.correlation.r},
                                    {"p", pair.correlation.p}});
  return json;
}

std::string Mm(const std::optional<double>& length_mm) {
  return length_mm ? fmt::format("{:.1f}", *length_mm) : "-";
}

std::string TextOf(const control::Comparison& c, const std::string& baseline) {
  std::string text = fmt::format("{}{}: {} {:.2f} (n = {}), {} {:.2f} (n = {})", c.measure,
                                 baseline.empty() ? "" : fmt::format(" beyond {}", baseline), c.a,
                                 c.of_a.mean, c.of_a.n, c.b, c.of_b.mean, c.of_b.n);
  if (c.means)
    text += fmt::format("; t({:.1f}) = {:.2f}, p = {:.2g}, corrected {:.2g}", c.means->df, c.means->t,
                        c.means->p, *c.corrected_p);
  if (c.pairs)
    text += fmt::format("; in pairs t({:.0f}) = {:.2f}, p = {:.2g}, decisive {:.2g}", c.pairs->df, c.pairs->t,
                        c.pairs->p, *c.decisive_p);
  return text + "\n";
}

std::string TextOf(const control::Study& study) {
  std::string text = fmt::format("'{}', mm: {}, {}\n{:<16}{:>10}{:>16}{:>12}{:>12}{:>10}\n",
                                 study.range.spacing, control::CountText(study.rows.size(), "participant"),
                                 control::CountText(study.sessions.size(), "session"), "participant",
                                 "estimate", "needed without", "needed", "shortfall", "after");
  for (const control::StudyRow& row : study.rows)
    text += fmt::format("{:<16}{:>10}{:>16}{:>12}{:>12}{:>10}\n", row.participant, Mm(row.estimate_before_mm),
                        Mm(row.needed_without_tools_mm), Mm(row.needed_mm), Mm(row.shortfall_mm()),
                        Mm(row.estimate_after_mm));
  if (study.shortfall_mm) {
    text += fmt::format("mean shortfall {:.1f} mm", study.shortfall_mm->mean);
    if (study.shortfall_mm->sd) text += fmt::format(", SD {:.1f}", *study.shortfall_mm->sd);
    if (study.shortfall_interval_mm)
      text += fmt::format(", 95 % interval of the mean {:.1f} to {:.1f}", study.shortfall_interval_mm->lower,
                          study.shortfall_interval_mm->upper);
    if (study.shortfall_bootstrap_mm)
      text += fmt::format(", by bootstrap {:.1f} to {:.1f}", study.shortfall_bootstrap_mm->lower,
                          study.shortfall_bootstrap_mm->upper);
    text += "\n";
  }
  for (const control::Comparison& c : study.comparisons) text += TextOf(c, study.baseline);
  for (const std::string& note : study.notes) text += "note: " + note + "\n";
  text.pop_back();
  return text;
}

CommandResult Run(const StudyOptions& options, const CommandContext& context) {
  control::SweepRequest request = options.request;
  if (!options.block.empty())
    request.sessions = control::SessionsOfBlock(request.sessions, options.block, context.stop);
  if (!options.has_range)
    request.range = control::FullRange(request.sessions.front(), request.range.spacing, context.stop);
  CommandResult result;
  result.hint = RunEngine(options.engine, &request, context);
  control::Study study = control::MakeStudy(request, context.progress, context.stop, options.baseline);
  if (!options.block.empty()) {
    std::string note =
        control::LeftOutNote(request.sessions.size(), options.request.sessions.size(), options.block);
    if (!note.empty()) study.notes.insert(study.notes.begin(), std::move(note));
  }
  result.json = StudyJson(study);
  result.json["block"] = options.block.empty() ? nlohmann::json() : nlohmann::json(options.block);
  result.text = TextOf(study);
  result.json["files"] = nlohmann::json::array();
  for (const auto& file : control::WriteStudy(study, request.folder, context.progress, context.stop)) {
    result.json["files"].push_back(file.string());
    result.text += "\n" + file.string();
  }
  return result;
}

}  // namespace

void AddStudyCommand(CLI::App& app, Choice* choice) {
  CLI::App* command = app.add_subcommand(
      "study", "several participants: space estimated, needed and missing; conditions compared");
  auto options = std::make_shared<StudyOptions>();
  command->add_option("SESSION", options->request.sessions, "the sessions (S.db), of one layout")->required();
  command->add_option_function<std::string>(
      "--spacing",
      [options](const std::string& text) {
        const auto range = ParseSpacingRange(text);
        options->has_range = range.has_value();
        options->request.range = range.value_or(control::SpacingRange{text});
      },
      "the gap to study, NAME or NAME=FROM:TO:STEP in mm (default: the layout's only one, over all that it "
      "may be)");
  command->add_option(
      "--baseline", options->baseline,
      "a condition: the others are compared by what each participant has more than in their own "
      "trials of it");
  command
      ->add_option("--out", options->request.folder,
                   "folder for report.html, report.pdf and the tables participants.csv, sessions.csv, "
                   "comparisons.csv; made if needed. What is done is kept in its cells, so that a study that "
                   "was ended early goes on")
      ->required();
  command->add_option("--block", options->block,
                      "only the sessions of this block of the study, as TRIAL.toml names it (default: all)");
  AddEngineOption(*command, &options->engine);
  command->callback(
      [=] { choice->action = [=](const CommandContext& context) { return Run(*options, context); }; });
}

}  // namespace elbowroom::cli
