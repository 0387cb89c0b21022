// Options and validators for quantities.
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

// The whole text as a finite number; nothing if it isn't one.
inline std::optional<double> ParseNumber(const std::string& text) {
  double value = 0.0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || stop != end || !std::isfinite(value)) return std::nullopt;
  return value;
}

// Accepts finite numbers above zero.
inline CLI::Validator PositiveLength() {
  return {[](const std::string& text) -> std::string {
            return ParseNumber(text).value_or(0.0) > 0.0 ? "" : "must be a positive number, not " + text;
          },
          "MM"};
}

// Accepts numbers of that range, both ends included; CLI::Range lets "nan" pass.
[[nodiscard]] CLI::Validator NumberWithin(double least, double most);

// Accepts finite numbers from zero.
inline CLI::Validator LengthFromZero() {
  return {[](const std::string& text) -> std::string {
            return ParseNumber(text).value_or(-1.0) >= 0.0 ? ""
                                                           : "must be 0 or a positive number, not " + text;
          },
          "MM"};
}

}  // namespace elbowroom::cli
