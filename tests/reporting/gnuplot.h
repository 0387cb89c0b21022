// Pictures by gnuplot.
#pragma once

#include <filesystem>
#include <string>

namespace elbowroom::reporting {

// Runs a script in its own folder. Throws: core::Error{kFile} in one line: gnuplot isn't there (what to
// install), or what it said.
void RunGnuplot(const std::filesystem::path& script, const std::string& program = "gnuplot");

}  // namespace elbowroom::reporting
