// What commands that sweep sessions have in common.
#pragma once

#include <optional>
#include <string>

#include "app/cli/options/command.h"
#include "app/control/sweep/spacing_sweep.h"
#include "app/control/sweep/sweep_engines.h"

namespace elbowroom::cli {

// NAME=FROM:TO:STEP, mm; nothing for another text.
[[nodiscard]] std::optional<control::SpacingRange> ParseSpacingRange(const std::string& text);

// --engine
void AddEngineOption(CLI::App& command, control::SweepEngine* engine);

// Has the engine keep the cells, and notes in the request which were there before. Gives a line on processes
// that were begun again; empty: none was. Throws: as control::RunSweepEngine.
std::string RunEngine(control::SweepEngine engine, control::SweepRequest* request,
                      const CommandContext& context);

}  // namespace elbowroom::cli
