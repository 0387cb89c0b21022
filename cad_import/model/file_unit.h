// The unit that a file's numbers are in.
#pragma once

#include <optional>
#include <string>

#include "core/units.h"

namespace elbowroom::cad_import {

struct FileUnit {
  double mm_per_unit = 1.0;  // > 0
  std::string name;          // "mm", "cm", "m", "in", "ft", "um", else "0.5 mm"
};

[[nodiscard]] FileUnit UnitOf(double mm_per_unit);
[[nodiscard]] FileUnit UnitOf(core::LengthUnit unit);

// The unit's name; "-", which names no unit, if there is none.
[[nodiscard]] std::string NameOrDash(const std::optional<core::LengthUnit>& unit);

}  // namespace elbowroom::cad_import
