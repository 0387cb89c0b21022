#include "tests/accuracy/chain/verdict_picture.h"

#include <fmt/format.h>

#include "core/error.h"
#include "core/system/whole_file.h"
#include "tests/reporting/gnuplot.h"

namespace elbowroom::accuracy {
namespace {

using core::Verdict;

constexpr int kFromMm = -10, kToMm = 40, kStepMm = 1;
constexpr double kBoxWidth = 1.04;  // of a step: no seams between boxes

// From the bottom up. Told apart by those who see colours differently, too (Okabe and Ito).
struct Layer {
  Verdict verdict;
  const char* color;
};
constexpr Layer kLayers[] = {{Verdict::kClear, "#009E73"},
                             {Verdict::kUndecided, "#c8c8c8"},
                             {Verdict::kNear, "#E69F00"},
                             {Verdict::kContact, "#D55E00"}};

// A line a step: its middle, and the sum of the layers' shares up to each, in per cent.
std::string DataBlock(const VerdictTally& tally, const std::string& name) {
  std::string text = fmt::format("${} << EOD\n", name);
  for (int from = kFromMm; from < kToMm; from += kStepMm) {
    const DistanceRange range{from, from + kStepMm};
    const auto all = static_cast<double>(tally.Count(range));
    if (all == 0.0) continue;
    text += fmt::format("{}", from + 0.5 * kStepMm);
    double sum = 0.0;
    for (const Layer& layer : kLayers) {
      sum += static_cast<double>(tally.Count(layer.verdict, range));
      text += fmt::format(" {:.2f}", 100.0 * sum / all);
    }
    text += "\n";
  }
  return text + "EOD\n";
}

// The highest first, so that the lower ones cover it.
std::string PlotCommand(const std::string& name) {
  std::string text = "plot ";
  for (std::size_t i = std::size(kLayers); i-- > 0;)
    text += fmt::format("${} using 1:{} with boxes fillstyle solid noborder lc rgb '{}' title '{}'{}", name,
                        i + 2, kLayers[i].color, core::ToString(kLayers[i].verdict), i > 0 ? ", " : "\n");
  return text;
}

std::string PlotAll(const std::vector<std::vector<VerdictPanel>>& rows) {
  std::string text = fmt::format("set multiplot layout {},{}\n", rows.size(), rows.front().size());
  for (std::size_t row = 0; row < rows.size(); ++row)
    for (std::size_t i = 0; i < rows[row].size(); ++i)
      text += fmt::format("set title '{}'\n{}", rows[row][i].title,
                          PlotCommand(fmt::format("shares{}_{}", row, i)));
  return text + "unset multiplot\n";
}

}  // namespace

void DrawVerdicts(const std::vector<std::vector<VerdictPanel>>& rows, const std::filesystem::path& stem) {
  core::Require(!rows.empty() && !rows.front().empty(), "a picture has panels");
  std::string script;
  for (std::size_t row = 0; row < rows.size(); ++row)
    for (std::size_t i = 0; i < rows[row].size(); ++i)
      script += DataBlock(rows[row][i].tally, fmt::format("shares{}_{}", row, i));
  script += fmt::format(
      "set xrange [{}:{}]\nset yrange [0:100]\nset boxwidth {}\nset border 3\nset tics nomirror out\nset "
      "xtics 10\n"
      "set ytics 25\nset xlabel 'true distance, mm (below 0: overlap)'\nset ylabel 'share, %'\n"
      "set key inside bottom right opaque box samplen 1.5\nset bmargin 3.5\n"
      "set arrow 1 from 0,0 to 0,100 nohead front lw 1.5 lc rgb '#000000'\n",
      kFromMm, kToMm, kBoxWidth * kStepMm);
  // Names without a folder: the script runs beside them.
  const std::string name = stem.filename().string(), plot = PlotAll(rows);
  const std::size_t wide = rows.front().size(), high = rows.size();
  script += fmt::format(
      "set terminal svg size {},{} font 'Sans,13' background rgb 'white'\nset output '{}.svg'\n{}",
      420 * wide, 340 * high, name, plot);
  script += fmt::format("set terminal pngcairo size {},{} font 'Sans,15'\nset output '{}.png'\n{}",
                        630 * wide, 510 * high, name, plot);
  const std::filesystem::path file = stem.string() + ".gnuplot";
  core::WriteWholeFile(file, script);
  reporting::RunGnuplot(file);
}

}  // namespace elbowroom::accuracy
