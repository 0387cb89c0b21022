// Sessions for tests of the sweep.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "core/ids.h"
#include "core/triangle_mesh.h"
#include "tests/support/run_program.h"

namespace elbowroom::tests {

// Six frames of the demo's task at 140 mm, from exact masks, the first of them `first`; how many of them
// payload A is touched in. The tongs are in use from the fourth on. 15 mm are required.
int RecordTaskFrames(const std::filesystem::path& path, core::FrameIndex first = 20,
                     const std::string& participant = "");

[[nodiscard]] test_support::ProgramRun RunSweep(const std::vector<std::filesystem::path>& sessions,
                                                const std::string& spacing, const std::filesystem::path& out,
                                                const std::vector<std::string>& more = {},
                                                const test_support::RunOptions& options = {});

// As STL text, in mm.
void WriteStl(const core::TriangleMesh& mesh, const std::filesystem::path& file);

// Files of cells that are whole, by their names from the folder of cells on.
[[nodiscard]] std::set<std::string> CellFiles(const std::filesystem::path& out);

// sweep.csv, sweep.svg and sweep.png have the same bytes in both folders.
void ExpectSameSweep(const std::filesystem::path& a, const std::filesystem::path& b);

}  // namespace elbowroom::tests
