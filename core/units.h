// Length units at the edges of the program (inside it there are only millimetres), angles, gravity.
#pragma once

#include <optional>
#include <string_view>

namespace elbowroom::core {

enum class LengthUnit { kMillimetre, kCentimetre, kMetre, kInch };

[[nodiscard]] double MillimetresPer(LengthUnit unit);

// "mm", "cm", "m" or "in"; nothing else.
[[nodiscard]] std::optional<LengthUnit> ParseLengthUnit(std::string_view text);
[[nodiscard]] std::string_view ToString(LengthUnit unit);

[[nodiscard]] constexpr double RadiansFromDegrees(double angle_deg) {
  return angle_deg * 3.14159265358979323846 / 180.0;
}
[[nodiscard]] constexpr double DegreesFromRadians(double angle_rad) {
  return angle_rad * 180.0 / 3.14159265358979323846;
}

inline constexpr double kGravityMmPerS2 = 9806.65;  // standard gravity

}  // namespace elbowroom::core
