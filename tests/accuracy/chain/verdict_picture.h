// The shares of the verdicts against the true distance.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tests/accuracy/chain/verdict_tally.h"

namespace elbowroom::accuracy {

struct VerdictPanel {
  std::string title;
  VerdictTally tally;
};

// Writes stem.svg, stem.png and the script with the data, stem.gnuplot: rows of panels below each other, all
// rows as long as the first. Throws: PreconditionError without panels; core::Error{kFile} as RunGnuplot.
void DrawVerdicts(const std::vector<std::vector<VerdictPanel>>& rows, const std::filesystem::path& stem);

}  // namespace elbowroom::accuracy
