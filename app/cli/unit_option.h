// Options whose words mean a quantity.
#pragma once

#include <CLI/CLI.hpp>
#include <charconv>
#include <cmath>
#include <optional>
#include <string>

#include "core/units.h"

namespace elbowroom::cli {

// --unit mm|cm|m|in
inline void AddUnitOption(CLI::App& command, std::optional<core::LengthUnit>* unit) {
  command
      .add_option_function<std::string>(
          "--unit", [unit](const std::string& text) { *unit = core::ParseLengthUnit(text); },
          "unit of the file's numbers")
      ->check(CLI::IsMember({"mm", "cm", "m", "in"}));
}

// Accepts finite numbers above zero.
inline CLI::Validator PositiveLength() {
  return {[](const std::string& text) -> std::string {
            double value = 0.0;
            const char* end = text.data() + text.size();
            const auto [stop, error] = std::from_chars(text.data(), end, value);
            const bool is_number = error == std::errc() && stop == end;
            return is_number && std::isfinite(value) && value > 0.0
                       ? ""
                       : "must be a positive number, not " + text;
          },
          "MM"};
}

}  // namespace elbowroom::cli
