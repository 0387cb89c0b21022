#include "cad_import/model/file_unit.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <utility>

namespace elbowroom::cad_import {

FileUnit UnitOf(double mm_per_unit) {
  constexpr double kSame = 1e-6;  // FBX and COLLADA hold single precision
  constexpr std::array<std::pair<double, const char*>, 6> kNames = {
      {{1.0, "mm"}, {10.0, "cm"}, {1000.0, "m"}, {25.4, "in"}, {304.8, "ft"}, {0.001, "um"}}};
  for (const auto& [mm, name] : kNames)
    if (std::abs(mm_per_unit - mm) <= kSame * mm) return {mm, name};
  return {mm_per_unit, fmt::format("{:g} mm", mm_per_unit)};
}

FileUnit UnitOf(core::LengthUnit unit) {
  return {core::MillimetresPer(unit), std::string(core::ToString(unit))};
}

std::string NameOrDash(const std::optional<core::LengthUnit>& unit) {
  return unit ? std::string(core::ToString(*unit)) : "-";
}

}  // namespace elbowroom::cad_import
