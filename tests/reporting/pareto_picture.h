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

struct ParetoPicture {
  std::string title;
  std::string time_label;
  std::string error_label;
  std::vector<ParetoPoint> points;
};

// Writes stem.svg, stem.png and the script with the data, stem.gnuplot: logarithmic axes, dominated points
// grey; errors below 1e-5 mm stand at 1e-5. Throws: core::Error as RunGnuplot; PreconditionError without
// points or with a time that isn't positive.
void DrawPareto(const ParetoPicture& picture, const std::filesystem::path& stem);

}  // namespace elbowroom::reporting
