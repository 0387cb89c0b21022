// What a figure was measured on.
#pragma once

#include <filesystem>
#include <string>

namespace elbowroom::reporting {

struct Machine {
  std::string processor;  // its model, as the system names it
  int cores = 0;
  std::string gl_driver;  // renderer and version; or why there is none
  std::string compiler;
  std::string date;    // UTC, day
  std::string commit;  // short, with a "+" where the tree differs from it; "unknown" without git
};

// Opens a GL context for a moment. `root`: the checkout.
[[nodiscard]] Machine ThisMachine(const std::filesystem::path& root);

// One line, in italics.
[[nodiscard]] std::string ToLine(const Machine& machine);

}  // namespace elbowroom::reporting
