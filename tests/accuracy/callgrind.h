// Instructions instead of milliseconds: the same on a loaded machine as on an idle one.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace elbowroom::accuracy {

struct CallgrindCount {
  std::int64_t instructions = 0;
  std::string output;  // the program's own stdout, without the line's end
};

// Runs a program under valgrind and counts what it executes inside the functions that match `function`
// (callgrind's toggle-collect). Throws: core::Error{kFile} in one line: valgrind isn't there (what to
// install), or what it said.
[[nodiscard]] CallgrindCount CountInstructions(const std::filesystem::path& program,
                                               const std::vector<std::string>& arguments,
                                               const std::string& function,
                                               const std::string& valgrind = "valgrind");

}  // namespace elbowroom::accuracy
