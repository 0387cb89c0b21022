#include <fmt/format.h>

#include "sessions/report/html_table.h"
#include "sessions/report/markup.h"
#include "sessions/report/report_page.h"

namespace elbowroom::sessions {
namespace {

std::string Sigma(double sigma_mm) { return fmt::format("{:.2f} mm", sigma_mm); }

// The make-up of what was allowed for, part by part.
std::string BudgetTable(const ReportData& data) {
  HtmlTable table({{"Part"},
                   {"Calibration <small>1 &sigma;</small>", true},
                   {"Pixel <small>1 &sigma;</small>", true},
                   {"Segmentation <small>1 &sigma;</small>", true},
                   {"Cameras at other instants <small>1 &sigma;</small>", true},
                   {"Given by the trial <small>1 &sigma;</small>", true},
                   {"Allowed for <small>2 &sigma; of all</small>", true}});
  for (const PartBudget& budget : data.budgets) {
    const core::ErrorBudget& largest = budget.largest;
    table.Add({Escaped(data.header.layout.parts[budget.part].name), Sigma(largest.calibration_mm),
               Sigma(largest.footprint_mm), Sigma(largest.segmentation_mm),
               data.stamps.empty() ? "not measured" : Sigma(largest.skew_mm),
               largest.given_mm > 0.0 ? Sigma(largest.given_mm) : "&ndash;", Sigma(largest.ExpandedMm())});
  }
  return table.empty() ? "" : table.Html();
}

std::string WhatIsAllowedFor(const ReportData& data) {
  const core::TrialInfo& trial = data.header.trial;
  if (data.header.rig_quality.errors) {
    return "<p class='lead'>What a verdict allows for is computed for each part in each frame, from the "
           "covariance of the rig&rsquo;s calibration, the size of a pixel there, and the silhouettes. The "
           "largest for each part:</p>\n" +
           BudgetTable(data);
  }
  const char* skew =
      data.budgets.empty()
          ? ""
          : " To that comes how far the hull may have moved between the cameras&rsquo; instants. The largest "
            "for each part:";
  if (trial.uncertainty_mm > 0.0)
    return fmt::format("<p class='lead'>Verdicts allow for {:.2f} mm, as the trial says.{}</p>\n",
                       trial.uncertainty_mm, skew) +
           BudgetTable(data);
  return fmt::format(
             "<p class='lead'>Verdicts allow for no error of the rig: its file has no covariance, or the "
             "trial says 0 mm.{}</p>\n",
             skew) +
         BudgetTable(data);
}

std::string GaugeLine(const std::optional<core::RigGauge>& gauge) {
  if (!gauge) return "<p class='lead'>The rig has no gauge: nobody measured a known rod with it.</p>\n";
  return fmt::format(
      "<p class='lead'>Gauge of {}: a rod of {:.2f} mm measured {:.2f} mm at the worst of {} places, with a "
      "bound "
      "of {:.2f} mm: <b>{}</b>.</p>\n",
      Escaped(gauge->made), gauge->true_diameter_mm, gauge->diameter_mm, gauge->places, gauge->bound_mm,
      gauge->passed ? "passed" : "failed");
}

}  // namespace

std::string TrustSection(const ReportData& data) {
  return "<section><h2>How sure this is</h2>\n" + WhatIsAllowedFor(data) +
         GaugeLine(data.header.rig_quality.gauge) + "</section>\n";
}

}  // namespace elbowroom::sessions
