// The figures at the report's top, those of the decision first.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "core/procedure/answers.h"
#include "sessions/report/report_document.h"
#include "sessions/report/verdict_text.h"

namespace elbowroom::sessions {
namespace {

// "without a tool 60 to 100 mm, with tongs 100 to 140 mm"
std::string NeedByTool(const SpacingStudy& study, bool is_whole_task) {
  std::vector<std::string> needs;
  for (const ToolNeed& tool : study.by_tool)
    needs.push_back(fmt::format("{} {}", tool.tool.empty() ? "without a tool" : "with " + tool.tool,
                                NeedText(tool.need, is_whole_task)));
  return fmt::format("{}", fmt::join(needs, ", "));
}

Tile NeedTile(const ReportData& data, const SpacingStudy& study) {
  const std::string by_tool = NeedByTool(study, data.status == SessionStatus::kComplete);
  return {"Space needed", SpaceNeeded(data),
          by_tool.empty() ? data.header.layout.spacings[study.spacing].name : by_tool};
}

std::string GaugeWord(const std::optional<core::RigGauge>& gauge) {
  if (!gauge) return "no gauge was measured";
  return gauge->passed ? "the gauge passed" : "the gauge failed";
}

// What verdicts allow for, at the most, and what that is made of.
Tile CertaintyTile(const ReportData& data) {
  const core::RigQuality& quality = data.header.rig_quality;
  const std::string gauge = GaugeWord(quality.gauge);
  const double given_mm = data.header.trial.uncertainty_mm;
  if (!data.budgets.empty()) {
    double largest_mm = 0.0;
    for (const PartBudget& budget : data.budgets)
      largest_mm = std::max(largest_mm, budget.largest.ExpandedMm());
    const char* of_what = quality.errors ? "2 \u03c3 at most: calibration, pixels, silhouettes"
                                         : "2 \u03c3 at most: as the trial says";
    return {"How sure", "\u00b1 " + Millimetres(largest_mm),
            fmt::format("{}{}; {}", of_what, data.stamps.empty() ? "" : ", skew of the cameras", gauge),
            kTrustId};
  }
  if (given_mm > 0.0)
    return {"How sure", "\u00b1 " + Millimetres(given_mm), "as the trial says; " + gauge, kTrustId};
  return {"How sure", "not stated", "the rig has no covariance; " + gauge, kTrustId};
}

}  // namespace

Tiles TilesOf(const ReportData& data) {
  const double duration_s = data.end_s - data.begin_s;
  const core::TrialInfo& trial = data.header.trial;
  Tiles tiles;
  const auto add = [&](Tile tile) { tiles.tiles.push_back(std::move(tile)); };
  if (data.judged_spacing) {
    const SpacingStudy& study = data.spacings[*data.judged_spacing];
    add({"Space provided", SpaceProvided(data), data.header.layout.spacings[study.spacing].name});
    add(NeedTile(data, study));
  }
  add({"Participant\u2019s estimate",
       trial.estimate_mm > 0.0 ? Millimetres(trial.estimate_mm) : "none given"});
  if (const auto after_mm = core::EstimatesOf(trial, data.events).after_mm)
    add({"Estimate afterwards", Millimetres(*after_mm)});
  if (data.judged_spacing && trial.estimate_mm > 0.0)
    add({"Shortfall", Shortfall(data), "space needed less the estimate"});
  if (trial.required_clearance_mm > 0.0)
    add({"Required clearance", Millimetres(trial.required_clearance_mm), "not part of the space needed"});
  add(CertaintyTile(data));
  if (data.has_outcome) add({"Touches", std::to_string(data.episodes.size()), TouchesByPart(data)});
  add({"Time in contact", fmt::format("{:.1f} s", data.in_contact_s),
       duration_s > 0.0 ? fmt::format("{:.0f} % of the trial", 100.0 * data.in_contact_s / duration_s) : ""});
  add({"Deepest", data.has_contact() ? Millimetres(data.deepest_mm) : "none"});
  return tiles;
}

}  // namespace elbowroom::sessions
