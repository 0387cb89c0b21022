// The workspace seen from above, with the width of the finger at each place.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

namespace elbowroom::accuracy {

struct FingerMapCell {
  Eigen::Vector2d middle_mm = Eigen::Vector2d::Zero();
  double width_mm = 0.0;
};

struct FingerMapPanel {
  std::string title;
  std::vector<FingerMapCell> cells;  // at least one; where there is none the picture stays grey
};

// Half of the sides. The workspace has its middle at the origin.
struct FingerMapScale {
  Eigen::Vector2d half_cell_mm;
  Eigen::Vector2d half_workspace_mm;
};

// Writes stem.svg, stem.png and the script with the data, stem.gnuplot: the panels beside each other. Throws:
// PreconditionError without panels or cells; core::Error{kFile} as RunGnuplot.
void DrawFingerMap(const std::vector<FingerMapPanel>& panels, const FingerMapScale& scale,
                   const std::filesystem::path& stem);

}  // namespace elbowroom::accuracy
