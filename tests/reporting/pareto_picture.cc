#include "tests/reporting/pareto_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "core/error.h"
#include "core/system/whole_file.h"
#include "tests/reporting/gnuplot.h"

namespace elbowroom::reporting {
namespace {

constexpr double kLeastErrorMm = 1e-5;
// Told apart by those who see colours differently, too (Okabe and Ito).
constexpr std::array<const char*, 6> kColors = {"#0072B2", "#D55E00", "#009E73",
                                                "#CC79A7", "#E69F00", "#56B4E9"};

std::vector<std::string> FamiliesOf(const std::vector<ParetoPanel>& panels) {
  std::vector<std::string> families;
  for (const ParetoPanel& panel : panels) {
    for (const ParetoPoint& point : panel.points)
      if (std::ranges::find(families, point.family) == families.end()) families.push_back(point.family);
  }
  return families;
}

// One data block a family: time, error, label; first all points, then the dominated ones.
std::string DataBlocks(const ParetoPanel& panel, std::size_t number,
                       const std::vector<std::string>& families) {
  const std::vector<bool> dominated = DominatedOf(panel.points);
  std::string text;
  for (std::size_t f = 0; f < families.size(); ++f) {
    std::string all, grey;
    for (std::size_t i = 0; i < panel.points.size(); ++i) {
      const ParetoPoint& point = panel.points[i];
      if (point.family != families[f]) continue;
      const std::string line = fmt::format("{} {} \"{}\"\n", point.time_ms,
                                           std::max(point.error_mm, kLeastErrorMm), point.setting);
      all += line;
      if (dominated[i]) grey += line;
    }
    if (grey.empty()) grey = "NaN NaN \"\"\n";
    text += fmt::format("$all{0}_{1} << EOD\n{2}EOD\n$grey{0}_{1} << EOD\n{3}EOD\n", number, f, all, grey);
  }
  return text;
}

// Settings that cost more are more exact: lines fall to the right, so that above on the right and below on
// the left of a point there is room for its label; a flat line has it above. Slanting labels beside a line
// leave each other room where points are close. One a family, in turns.
constexpr std::array kLabelPlaces = {"center offset 0,0.9", "left rotate by 25 offset 0.7,0.5",
                                     "center offset 0,1.6", "left rotate by 25 offset 0.7,0.5",
                                     "right offset -0.9,-0.5"};

// As gnuplot takes text in single quotes.
std::string Quoted(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? std::string("''") : std::string(1, c);
  return quoted + "'";
}

std::string PlotCommand(const ParetoPanel& panel, std::size_t number,
                        const std::vector<std::string>& families) {
  std::string text = "plot ";
  for (std::size_t f = 0; f < families.size(); ++f) {
    if (std::ranges::find(panel.points, families[f], &ParetoPoint::family) == panel.points.end()) continue;
    const char* color = kColors[f % kColors.size()];
    const char* place = kLabelPlaces[f % kLabelPlaces.size()];
    text += fmt::format(
        "$all{0}_{1} using 1:2 with linespoints pt 7 ps 1.4 lw 2 lc rgb '{2}' title {3}, "
        "$grey{0}_{1} using 1:2 with points pt 7 ps 1.4 lc rgb '#b8b8b8' notitle, "
        "$all{0}_{1} using 1:2:3 with labels {4} tc rgb '{2}' notitle, ",
        number, f, color, Quoted(families[f]), place);
  }
  return text +
         "NaN with points pt 7 ps 1.4 lc rgb '#b8b8b8' title 'dominated by another setting or method'\n";
}

// All panels, for a terminal that has been set.
std::string PlotAll(const ParetoPicture& picture, const std::vector<std::string>& families) {
  std::string text = fmt::format("set multiplot layout {},1\n", picture.panels.size());
  for (std::size_t i = 0; i < picture.panels.size(); ++i) {
    text += fmt::format("set title {}\n", Quoted(picture.panels[i].title));
    text += PlotCommand(picture.panels[i], i, families);
  }
  return text + "unset multiplot\n";
}

}  // namespace

std::vector<bool> DominatedOf(const std::vector<ParetoPoint>& points) {
  std::vector<bool> dominated;
  for (const ParetoPoint& point : points) {
    dominated.push_back(std::ranges::any_of(points, [&](const ParetoPoint& other) {
      const bool is_no_worse = other.time_ms <= point.time_ms && other.error_mm <= point.error_mm;
      return is_no_worse && (other.time_ms < point.time_ms || other.error_mm < point.error_mm);
    }));
  }
  return dominated;
}

void DrawPareto(const ParetoPicture& picture, const std::filesystem::path& stem) {
  core::Require(!picture.panels.empty(), "a picture has panels");
  for (const ParetoPanel& panel : picture.panels) {
    core::Require(!panel.points.empty(), "a panel has points");
    for (const ParetoPoint& point : panel.points)
      core::Require(point.time_ms > 0.0, "a run time is positive");
  }
  const std::vector<std::string> families = FamiliesOf(picture.panels);
  std::string script;
  for (std::size_t i = 0; i < picture.panels.size(); ++i)
    script += DataBlocks(picture.panels[i], i, families);
  script += fmt::format(
      "set logscale xy\nset grid lc rgb '#cccccc'\nset border 3\nset tics nomirror\nset key bottom right "
      "Left "
      "reverse\n"
      "set xlabel {}\nset ylabel {}\nset format xy '%g'\nset offsets graph 0.08, graph "
      "0.28, graph 0.15, graph 0.1\n",
      Quoted(picture.time_label), Quoted(picture.error_label));
  // Names without a folder: the script runs beside them.
  const std::string name = stem.filename().string(), plot = PlotAll(picture, families);
  const std::size_t panels = picture.panels.size();
  script += fmt::format(
      "set terminal svg size 900,{} font 'Sans,15' background rgb 'white'\nset output '{}.svg'\n{}",
      560 * panels, name, plot);
  script += fmt::format("set terminal pngcairo size 1350,{} font 'Sans,17'\nset output '{}.png'\n{}",
                        840 * panels, name, plot);
  const std::filesystem::path file = stem.string() + ".gnuplot";
  core::WriteWholeFile(file, script);
  RunGnuplot(file);
}

}  // namespace elbowroom::reporting
