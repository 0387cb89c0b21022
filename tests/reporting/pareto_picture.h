// Run time against error, all methods in one picture.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace elbowroom::reporting {

struct ParetoPoint {
  std::string family;   // of one colour, joined by a line
  std::string setting;  // written beside the point
  double time_ms = 0.0;
  double error_mm = 0.0;
};

// One flag a point: another is at least as fast and as exact, and better in one of the two.
[[nodiscard]] std::vector<bool> DominatedOf(const std::vector<ParetoPoint>& points);

struct ParetoPanel {
  std::string title;
  std::vector<ParetoPoint> points;
};

struct ParetoPicture {
  std::string time_label;
  std::string error_label;
  std::vector<ParetoPanel> panels;  // one below the other; the same families have the same colours
};

// Writes stem.svg, stem.png and the script with the data, stem.gnuplot: logarithmic axes, dominated points
// grey (within their panel); errors below 1e-5 mm stand at 1e-5. Throws: core::Error as RunGnuplot, also
// where a panel's points have but one time or one error; PreconditionError without panels, for one without
// points, or for a time that isn't positive.
void DrawPareto(const ParetoPicture& picture, const std::filesystem::path& stem);

}  // namespace elbowroom::reporting
