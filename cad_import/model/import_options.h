// How a CAD file is to be read.
#pragma once

#include <cstdint>
#include <optional>

#include "core/units.h"

namespace elbowroom::cad_import {

inline constexpr double kUsualToleranceMm = 0.2;

// What reading one file may take before it is given up.
struct ImportLimits {
  std::int64_t memory_bytes = std::int64_t{4} << 30;  // of address space, > 0
  double time_s = 120.0;                              // > 0
};

struct ImportOptions {
  std::optional<core::LengthUnit> unit{};  // of the file's numbers; overrides what the file says
  std::optional<core::LengthUnit> unit_if_file_has_none{};  // when `unit` isn't given
  // > 0; how far triangles may be from the faces of STEP, IGES and BREP; if not given: kUsualToleranceMm, or
  // a thousandth of a body's diagonal where that is less.
  std::optional<double> tolerance_mm{};
  ImportLimits limits{};

  // Throws: Error{kRange} naming the option that is out of range.
  void Validate() const;
};

}  // namespace elbowroom::cad_import
