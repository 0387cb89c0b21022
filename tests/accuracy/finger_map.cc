#include "tests/accuracy/finger_map.h"

#include <fmt/format.h>

#include "core/error.h"
#include "core/system/whole_file.h"
#include "tests/reporting/gnuplot.h"

namespace elbowroom::accuracy {
namespace {

// From too thin to too wide; the finger itself is light, so that its figures are easy to read.
constexpr const char* kPalette = "0 '#b2182b', 5 '#f4a582', 10 '#f7f7f7', 15 '#92c5de', 25 '#2166ac'";
constexpr double kWidestMm = 25.0;

std::string DataBlock(const FingerMapPanel& panel, std::size_t number) {
  std::string text = fmt::format("$cells{} << EOD\n", number);
  for (const FingerMapCell& cell : panel.cells)
    text += fmt::format("{:.1f} {:.1f} {:.2f}\n", cell.middle_mm.x(), cell.middle_mm.y(), cell.width_mm);
  return text + "EOD\n";
}

std::string PlotAll(const std::vector<FingerMapPanel>& panels, const FingerMapScale& scale) {
  std::string text = fmt::format("set multiplot layout 1,{}\n", panels.size());
  for (std::size_t i = 0; i < panels.size(); ++i) {
    text += fmt::format(
        "set title '{0}'\n"
        "plot $cells{1} using 1:2:({2:.1f}):({3:.1f}):3 with boxxyerror fillstyle solid noborder lc palette "
        "notitle, $cells{1} using 1:2:(sprintf('%.0f', $3)) with labels tc rgb '#000000' notitle\n",
        panels[i].title, i, scale.half_cell_mm.x(), scale.half_cell_mm.y());
  }
  return text + "unset multiplot\n";
}

std::string Settings(const FingerMapScale& scale) {
  return fmt::format(
      "set xrange [{0:.1f}:{1:.1f}]\nset yrange [{2:.1f}:{3:.1f}]\nset size ratio -1\nunset key\n"
      "set object 1 rectangle from graph 0,0 to graph 1,1 behind fillcolor rgb '#cccccc' fillstyle solid "
      "noborder\n"
      "set palette defined ({4})\nset cbrange [0:{5}]\nset cblabel 'width, mm'\n"
      "set tics nomirror\nset xtics 500\nset ytics 500\n"
      "set xlabel 'x, mm (the participant stands below)'\nset ylabel 'y, mm'\n",
      -scale.half_workspace_mm.x(), scale.half_workspace_mm.x(), -scale.half_workspace_mm.y(),
      scale.half_workspace_mm.y(), kPalette, kWidestMm);
}

}  // namespace

void DrawFingerMap(const std::vector<FingerMapPanel>& panels, const FingerMapScale& scale,
                   const std::filesystem::path& stem) {
  core::Require(!panels.empty(), "a picture has panels");
  std::string script;
  for (std::size_t i = 0; i < panels.size(); ++i) {
    core::Require(!panels[i].cells.empty(), "a panel has cells");
    script += DataBlock(panels[i], i);
  }
  script += Settings(scale);
  // Names without a folder: the script runs beside them.
  const std::string name = stem.filename().string(), plot = PlotAll(panels, scale);
  script += fmt::format(
      "set terminal svg size {},360 font 'Sans,12' background rgb 'white'\nset output '{}.svg'\n{}",
      480 * panels.size(), name, plot);
  script += fmt::format("set terminal pngcairo size {},540 font 'Sans,14'\nset output '{}.png'\n{}",
                        720 * panels.size(), name, plot);
  const std::filesystem::path file = stem.string() + ".gnuplot";
  core::WriteWholeFile(file, script);
  reporting::RunGnuplot(file);
}

}  // namespace elbowroom::accuracy
