#include <fmt/format.h>

#include "sessions/report/report_document.h"

namespace elbowroom::sessions {
namespace {

std::string Sigma(double sigma_mm) { return fmt::format("{:.2f} mm", sigma_mm); }

DocumentColumn SigmaColumn(const char* title) { return {WithRemark(title, "1 \u03c3"), true}; }

// The make-up of what was allowed for, part by part.
void AddBudgets(const ReportData& data, std::vector<Block>* blocks) {
  DocumentTable table{{{"Part"},
                       SigmaColumn("Calibration"),
                       SigmaColumn("Pixel"),
                       SigmaColumn("Segmentation"),
                       SigmaColumn("Cameras at other instants"),
                       SigmaColumn("Given by the trial"),
                       {WithRemark("Allowed for", "2 \u03c3 of all"), true}},
                      {}};
  for (const PartBudget& budget : data.budgets) {
    const core::ErrorBudget& largest = budget.largest;
    table.rows.push_back(
        {{data.header.layout.parts[budget.part].name, Sigma(largest.calibration_mm),
          Sigma(largest.footprint_mm), Sigma(largest.segmentation_mm),
          data.stamps.empty() ? "not measured" : Sigma(largest.skew_mm),
          largest.given_mm > 0.0 ? Sigma(largest.given_mm) : kNothing, Sigma(largest.ExpandedMm())}});
  }
  if (!table.rows.empty()) blocks->push_back(std::move(table));
}

std::string WhatIsAllowedFor(const ReportData& data) {
  const core::TrialInfo& trial = data.header.trial;
  if (data.header.rig_quality.errors) {
    return "What a verdict allows for is computed for each part in each frame, from the covariance of the "
           "rig\u2019s calibration, the size of a pixel there, and the silhouettes. The largest for each "
           "part:";
  }
  const char* skew = data.budgets.empty()
                         ? ""
                         : " To that comes how far the hull may have moved between the cameras\u2019 "
                           "instants. The largest for each part:";
  if (trial.uncertainty_mm > 0.0)
    return fmt::format("Verdicts allow for {:.2f} mm, as the trial says.{}", trial.uncertainty_mm, skew);
  return fmt::format(
      "Verdicts allow for no error of the rig: its file has no covariance, or the trial says 0 mm.{}", skew);
}

RichText GaugeLine(const std::optional<core::RigGauge>& gauge) {
  if (!gauge) return "The rig has no gauge: nobody measured a known rod with it.";
  RichText line = fmt::format(
      "Gauge of {}: a rod of {:.2f} mm measured {:.2f} mm at the worst of {} places, with a bound of {:.2f} "
      "mm: ",
      gauge->made, gauge->true_diameter_mm, gauge->diameter_mm, gauge->places, gauge->bound_mm);
  line += Strong(gauge->passed ? "passed" : "failed");
  line += {.text = "."};
  return line;
}

}  // namespace

Section TrustSection(const ReportData& data) {
  Section section{.id = kTrustId,
                  .blocks = {Heading{"How sure this is"}, Paragraph{WhatIsAllowedFor(data), true}}};
  AddBudgets(data, &section.blocks);
  section.blocks.emplace_back(Paragraph{GaugeLine(data.header.rig_quality.gauge), true});
  return section;
}

}  // namespace elbowroom::sessions
