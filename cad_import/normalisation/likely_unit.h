// The unit that numbers without one are most likely in.
#pragma once

#include <array>

#include "core/units.h"

namespace elbowroom::cad_import {

inline constexpr std::array kLengthUnits = {core::LengthUnit::kMillimetre, core::LengthUnit::kCentimetre,
                                            core::LengthUnit::kMetre, core::LengthUnit::kInch};

// The unit that brings the longest edge, > 0 in the file's own unit, into the usual sizes of what is checked
// at a table, or nearest to them by ratio; a unit in which CAD is rarely drawn must be nearer by its penalty.
[[nodiscard]] core::LengthUnit LikelyUnit(double longest);

}  // namespace elbowroom::cad_import
