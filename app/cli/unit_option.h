// --unit mm|cm|m|in
#pragma once

#include <CLI/CLI.hpp>
#include <optional>

#include "core/units.h"

namespace elbowroom::cli {

inline void AddUnitOption(CLI::App& command, std::optional<core::LengthUnit>* unit) {
  command
      .add_option_function<std::string>(
          "--unit", [unit](const std::string& text) { *unit = core::ParseLengthUnit(text); },
          "unit of the file's numbers")
      ->check(CLI::IsMember({"mm", "cm", "m", "in"}));
}

}  // namespace elbowroom::cli
