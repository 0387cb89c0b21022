// --spacing NAME=MM: gaps of a layout set on the command line.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "core/layout.h"

namespace elbowroom::cli {

struct SpacingSetting {
  std::string name;
  double gap_mm = 0.0;
};

// May be given several times; the last one for a name holds.
void AddSpacingOption(CLI::App& command, std::vector<SpacingSetting>* settings);

// The layout's initial gaps with these in place. Throws: core::Error{kRange} for a name that no spacing has
// or a gap beyond its limits.
[[nodiscard]] std::vector<double> SpacingsWith(const core::Layout& layout,
                                               const std::vector<SpacingSetting>& settings);

}  // namespace elbowroom::cli
