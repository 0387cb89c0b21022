// docs/accuracy.md, "finger", "finger_directions" and "finger_cameras"; docs/pictures/finger_width.
#include <fmt/format.h>

#include <functional>
#include <map>
#include <utility>

#include "recon/synthetic/rig_presets.h"
#include "tests/accuracy/disturbed_rig.h"
#include "tests/accuracy/finger_map.h"
#include "tests/accuracy/measurements.h"
#include "tests/accuracy/moving_finger.h"
#include "tests/accuracy/quantile.h"
#include "tests/reporting/machine_line.h"
#include "tests/reporting/markdown_table.h"
#include "tests/reporting/marked_section.h"

namespace elbowroom::accuracy {
namespace {

const Eigen::Vector3i kPlacesAlong(7, 6, 4);
constexpr int kDraws = 4;

using WidthOf = std::function<std::optional<double>(const FingerWidths&)>;

WidthOf InHull(double SectionWidths::*width_mm) {
  return [=](const FingerWidths& widths) {
    return widths.in_hull ? std::optional((*widths.in_hull).*width_mm) : std::nullopt;
  };
}

std::optional<double> OnPlanes(const FingerWidths& widths) { return widths.on_planes_mm; }

WidthSummary SummaryOf(const std::vector<FingerWidths>& widths, const WidthOf& width, double tolerance_mm) {
  std::vector<std::optional<double>> widths_mm;
  for (const FingerWidths& at : widths) widths_mm.push_back(width(at));
  return Summarise(widths_mm, tolerance_mm);
}

std::vector<std::string> Cells(const WidthSummary& summary) {
  using reporting::ThreeDigits;
  if (summary.lost == summary.measured) return {"-", "-", "-", "-"};
  return {ThreeDigits(summary.median_mm), ThreeDigits(summary.low_mm), ThreeDigits(summary.high_mm),
          ThreeDigits(summary.worst_mm)};
}

void AddRow(const std::string& name, const std::string& width, const WidthSummary& summary,
            double tolerance_mm, reporting::Table* table) {
  std::vector<std::string> row = {name, width};
  for (std::string& cell : Cells(summary)) row.push_back(std::move(cell));
  row.push_back(fmt::format("{:.1f} (± {:.0f} mm)", 100.0 * summary.within_share, tolerance_mm));
  row.push_back(fmt::format("{} of {}", summary.lost, summary.measured));
  table->rows.push_back(std::move(row));
}

void AddRows(const FingerReconstruction& reconstruction, const std::vector<FingerWidths>& widths,
             reporting::Table* table) {
  const auto add = [&](const std::string& name, const std::string& of, const WidthOf& width,
                       double tolerance_mm) {
    AddRow(name, of, SummaryOf(widths, width, tolerance_mm), tolerance_mm, table);
  };
  add(reconstruction.name, "as seen", InHull(&SectionWidths::seen_mm), kPaperHullMm);
  add(reconstruction.name, "smallest", InHull(&SectionWidths::smallest_mm), kPaperHullMm);
  add(reconstruction.name, "largest", InHull(&SectionWidths::largest_mm), kPaperHullMm);
  if (reconstruction.is_drawn)
    add(reconstruction.name + ", on planes 15 mm apart", "as seen", OnPlanes, kPaperRenderingMm);
}

std::vector<FingerPlace> SeenBy(int cameras, const std::vector<FingerPlace>& places) {
  std::vector<FingerPlace> seen;
  for (const FingerPlace& place : places)
    if (place.cameras == cameras) seen.push_back(place);
  return seen;
}

// From above: the median of all that lie over one another, orientations and draws.
FingerMapPanel PanelOf(const std::string& title, const std::vector<FingerPlace>& places,
                       const std::vector<FingerWidths>& widths, const WidthOf& width) {
  std::map<std::pair<double, double>, std::vector<double>> columns;
  const std::size_t draws = widths.size() / places.size();
  for (std::size_t i = 0; i < widths.size(); ++i) {
    const Eigen::Vector3d& middle = places[i / draws].middle_in_world;
    if (const auto width_mm = width(widths[i])) columns[{middle.x(), middle.y()}].push_back(*width_mm);
  }
  FingerMapPanel panel{title, {}};
  for (const auto& [at, column] : columns)
    panel.cells.push_back({{at.first, at.second}, Quantile(column, 0.5)});
  return panel;
}

std::string CamerasTable(const core::Rig& rig, const std::vector<FingerPlace>& places,
                         const FingerMasks& masks) {
  reporting::Table table{
      {"cameras that see the place", "places", "lost under `outside`", "lost under `abstain`",
       "as seen: median, mm", "5 %", "95 %", "worst", "largest: median, mm"},
      {}};
  core::Rig abstaining = rig;
  abstaining.unseen = core::UnseenPolicy::kAbstain;
  const WidthOf seen = InHull(&SectionWidths::seen_mm), largest = InHull(&SectionWidths::largest_mm);
  for (int cameras = static_cast<int>(rig.cameras.size()); cameras >= 0; --cameras) {
    const std::vector<FingerPlace> some = SeenBy(cameras, places);
    if (some.empty()) continue;
    const auto outside = MeasureWidths(PerfectMasks(rig, masks), some);
    const auto abstain = MeasureWidths(PerfectMasks(abstaining, masks), some);
    const WidthSummary summary = SummaryOf(abstain, seen, kPaperHullMm);
    std::vector<std::string> row = {fmt::format("{}", cameras), fmt::format("{}", some.size()),
                                    fmt::format("{}", SummaryOf(outside, seen, kPaperHullMm).lost),
                                    fmt::format("{}", summary.lost)};
    for (std::string& cell : Cells(summary)) row.push_back(std::move(cell));
    row.push_back(Cells(SummaryOf(abstain, largest, kPaperHullMm)).front());
    table.rows.push_back(std::move(row));
  }
  return reporting::ToMarkdown(table);
}

struct Reconstructed {
  FingerReconstruction how;
  std::vector<FingerWidths> widths;
};

Reconstructed Reconstruct(FingerReconstruction how, const std::vector<FingerPlace>& places) {
  fmt::print(stderr, "finger: {}, {} places\n", how.name, places.size());
  std::vector<FingerWidths> widths = MeasureWidths(how, places);
  return {std::move(how), std::move(widths)};
}

// The width as seen of those that point somewhere in one half of the table; of a reconstruction with one
// draw.
WidthSummary SummaryOfHalf(const Reconstructed& reconstructed, const std::vector<FingerPlace>& places,
                           const std::string& direction, bool is_near) {
  std::vector<FingerWidths> some;
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (places[i].direction == direction && (places[i].middle_in_world.y() < 0.0) == is_near)
      some.push_back(reconstructed.widths[i]);
  }
  return SummaryOf(some, InHull(&SectionWidths::seen_mm), kPaperHullMm);
}

std::string DirectionsTable(const std::vector<Reconstructed>& perfect,
                            const std::vector<FingerPlace>& places) {
  reporting::Table table{{"reconstruction", "finger points", "far half: median, mm", "95 %", "% within 5 mm",
                          "near half: median, mm", "95 %", "% within 5 mm"},
                         {}};
  for (const Reconstructed& reconstructed : perfect) {
    for (const std::string direction : kFingerDirections) {
      std::vector<std::string> row = {reconstructed.how.name, direction};
      for (const bool is_near : {false, true}) {
        const WidthSummary summary = SummaryOfHalf(reconstructed, places, direction, is_near);
        row.push_back(reporting::ThreeDigits(summary.median_mm));
        row.push_back(reporting::ThreeDigits(summary.high_mm));
        row.push_back(fmt::format("{:.0f}", 100.0 * summary.within_share));
      }
      table.rows.push_back(std::move(row));
    }
  }
  return reporting::ToMarkdown(table);
}

void DrawMap(const core::Rig& rig, const std::vector<FingerPlace>& places, const Reconstructed& perfect,
             const Reconstructed& disturbed, const std::filesystem::path& stem) {
  const WidthOf seen = InHull(&SectionWidths::seen_mm);
  const Eigen::Vector2d size_mm = rig.workspace_mm.sizes().head<2>();
  DrawFingerMap({PanelOf("hull of perfect cameras", places, perfect.widths, seen),
                 PanelOf("hull, the errors all together", places, disturbed.widths, seen),
                 PanelOf("the same on planes 15 mm apart", places, disturbed.widths, OnPlanes)},
                {0.5 * size_mm.cwiseQuotient(kPlacesAlong.head<2>().cast<double>()), 0.5 * size_mm}, stem);
}

std::string WidthsTable(const std::vector<Reconstructed>& all) {
  reporting::Table table{{"reconstruction", "width", "median, mm", "5 %", "95 %", "worst",
                          "% within the paper's estimate", "lost"},
                         {}};
  for (const Reconstructed& reconstructed : all) AddRows(reconstructed.how, reconstructed.widths, &table);
  return reporting::ToMarkdown(table);
}

}  // namespace

void MeasureFinger(const std::filesystem::path& docs) {
  const core::Rig rig = recon::PaperRig();
  const std::vector<FingerPlace> everywhere = FingerPlaces(rig, kPlacesAlong);
  const std::vector<FingerPlace> places = SeenBy(static_cast<int>(rig.cameras.size()), everywhere);
  const std::filesystem::path file = docs / "accuracy.md";
  std::vector<Reconstructed> all;
  for (const FingerHolder holder : {FingerHolder::kNothing, FingerHolder::kFist})
    all.push_back(Reconstruct(PerfectCameras(rig, holder), places));
  reporting::WriteSection(file, "finger_directions", DirectionsTable(all, places));
  fmt::print(stderr, "finger: masks of {} places\n", everywhere.size());
  const FingerMasks masks = PerfectMasksOf(rig, everywhere);
  reporting::WriteSection(
      file, "finger_cameras",
      CamerasTable(rig, everywhere, masks) + "\n" + reporting::ToLine(reporting::ThisMachine(docs / "..")));
  all.push_back(Reconstruct(PerfectMasks(rig, masks), places));
  all.push_back(Reconstruct(DisturbedRig(rig, kDraws), places));
  DrawMap(rig, places, all[1], all[3], docs / "pictures" / "finger_width");
  reporting::WriteSection(file, "finger", WidthsTable(all));
}

}  // namespace elbowroom::accuracy
