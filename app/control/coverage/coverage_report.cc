#include "app/control/coverage/coverage_report.h"

#include <fmt/format.h>

#include <map>
#include <string>

#include "app/control/coverage/coverage_pictures.h"
#include "app/control/coverage/coverage_text.h"
#include "app/control/coverage/coverage_volume.h"
#include "cad_import/formats/format_modules.h"
#include "sessions/report/html_page.h"
#include "sessions/report/html_table.h"
#include "sessions/report/markup.h"
#include "sessions/report/whole_files.h"

namespace elbowroom::control {
namespace {

using core::Spread;
using recon::CoverageFigures;
using sessions::Escaped;
using sessions::HtmlTable;

std::string PageHeader(const CoverageOutcome& outcome) {
  return fmt::format(
      "<header><p class='kicker'>Elbowroom coverage report</p><h1>{}</h1><p class='facts'>{} cameras "
      "&middot; {} places, {} mm "
      "apart &middot; a ball of {} mm for the phantom volume &middot; unseen: {}</p></header>\n",
      Escaped(outcome.rig.rig.name), outcome.rig.rig.cameras.size(), outcome.figures.nodes,
      MmText(outcome.grid.edge_mm), MmText(outcome.options.ball_mm),
      outcome.rig.rig.unseen == core::UnseenPolicy::kAbstain ? "abstain" : "outside");
}

std::string Verdict(const CoverageOutcome& outcome) {
  const CoverageFigures& figures = outcome.figures;
  const std::string error =
      figures.uncertainty_mm
          ? fmt::format(
                "A point in the workspace is located to &plusmn; {} mm (1&sigma;, median), {} mm for "
                "95&nbsp;%",
                MmText(figures.uncertainty_mm->median), MmText(figures.uncertainty_mm->p95))
          : std::string("No part of the workspace is seen by two cameras");
  return fmt::format(
      "<section><div class='verdict{}'><p>{}.</p><p>Two cameras or more see {} of it; a thing can be found "
      "in {} of it.</p></div></section>\n",
      outcome.warnings.empty() ? "" : " broken", error, PercentText(figures.seen_share),
      PercentText(figures.reach_share));
}

std::string ListSection(const std::string& title, const std::vector<std::string>& lines) {
  if (lines.empty()) return "";
  std::string html = fmt::format("<section><h2>{}</h2><ul>", title);
  for (const std::string& line : lines) html += fmt::format("<li>{}</li>", Escaped(line));
  return html + "</ul></section>\n";
}

std::string ValueText(double value, CoverageQuantity quantity) {
  switch (quantity) {
    case CoverageQuantity::kUncertainty:
    case CoverageQuantity::kFootprint:
      return MmText(value) + " mm";
    case CoverageQuantity::kCameras:
      return fmt::format("{:.0f}", value);
    case CoverageQuantity::kPhantom:
      return PercentText(value);
  }
  return "";
}

void AddRows(const std::string& where, const CoverageFigures& figures, HtmlTable* table) {
  for (const CoverageQuantity quantity : kCoverageQuantities) {
    const std::optional<Spread>& spread = SpreadOf(figures, quantity);
    const auto cell = [&](double value) { return spread ? ValueText(value, quantity) : std::string("-"); };
    const Spread values = spread.value_or(Spread{});
    table->Add({where, TitleOf(quantity), cell(values.median), cell(values.p95), cell(values.max),
                quantity == CoverageQuantity::kCameras ? fmt::format("fewest: {}", figures.fewest_cameras)
                                                       : std::string()});
  }
}

std::string FigureTable(const CoverageOutcome& outcome) {
  HtmlTable table({{"where"}, {"what"}, {"median", true}, {"95 %", true}, {"largest", true}, {""}});
  AddRows("the workspace", outcome.figures, &table);
  for (const PartCoverage& part : outcome.parts)
    AddRows(fmt::format("near {}<small> ({} places within {} mm)</small>", Escaped(part.name),
                        part.figures.nodes, MmText(outcome.near_mm)),
            part.figures, &table);
  return "<section><h2>Figures</h2>" + table.Html() + "</section>\n";
}

std::string NextTable(const CoverageOutcome& outcome) {
  if (!outcome.next || outcome.next->best.empty()) return "";
  HtmlTable table({{"camera at"},
                   {"looks at"},
                   {"error, median", true},
                   {"error, 95 %", true},
                   {"phantom, median", true},
                   {"two cameras see", true},
                   {"found in", true}});
  const auto add = [&](const std::string& at, const std::string& look_at, const CoverageFigures& figures) {
    const Spread error = figures.uncertainty_mm.value_or(Spread{}),
                 phantom = figures.phantom_fraction.value_or(Spread{});
    table.Add({at, look_at, figures.uncertainty_mm ? MmText(error.median) + " mm" : "-",
               figures.uncertainty_mm ? MmText(error.p95) + " mm" : "-",
               figures.phantom_fraction ? PercentText(phantom.median) : "-", PercentText(figures.seen_share),
               PercentText(figures.reach_share)});
  };
  add("as it is", "", outcome.next->before);
  for (const recon::ProposedCamera& camera : outcome.next->best)
    add(PlaceText(camera.center_mm), PlaceText(camera.look_at_mm), camera.after);
  return fmt::format(
      "<section><h2>One more camera</h2><p class='lead'>{} places and directions were tried, over {} places "
      "of the workspace. The lens is "
      "that of {}; the camera is taken to be calibrated as well as the median one.</p>{}"
      "</section>\n",
      outcome.next->tried, outcome.next->points,
      Escaped(outcome.rig.rig.cameras[outcome.next->lens_of].name()), table.Html());
}

std::string Pictures(const CoverageOutcome& outcome) {
  std::string html;
  for (const CoverageQuantity quantity : kCoverageQuantities)
    html += fmt::format("<section><h2>{}</h2><p class='lead'>{}</p>{}</section>\n", TitleOf(quantity),
                        Escaped(ExplanationOf(quantity, outcome)), CoveragePicture(outcome, quantity));
  return html;
}

}  // namespace

std::vector<std::filesystem::path> WriteCoverage(const CoverageOutcome& outcome,
                                                 const std::filesystem::path& folder) {
  std::map<std::string, std::string> files;
  files["coverage.html"] = sessions::HtmlPage(
      fmt::format("Coverage: {}", Escaped(outcome.rig.rig.name)),
      PageHeader(outcome) + Verdict(outcome) + ListSection("Warnings", outcome.warnings) +
          ListSection("What to do", outcome.advice) + FigureTable(outcome) + NextTable(outcome) +
          Pictures(outcome) +
          "<footer>coverage.glb beside this page shows the error of a point in space.</footer>");
  for (const CoverageQuantity quantity : kCoverageQuantities)
    files[fmt::format("{}.svg", NameOf(quantity))] = StandaloneSvg(CoveragePicture(outcome, quantity));
  files["coverage.glb"] =
      cad_import::LoadedMeshFormats().encode(CoverageVolume(outcome), folder / "coverage.glb");
  sessions::WriteWholeFiles(folder, files);
  std::vector<std::filesystem::path> paths;
  for (const auto& [name, content] : files) paths.push_back(folder / name);
  return paths;
}

}  // namespace elbowroom::control
