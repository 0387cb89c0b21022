// How a CAD file is to be read.
#pragma once

#include <cstdint>
#include <optional>

#include "core/units.h"

namespace elbowroom::cad_import {

// What reading one file may take before it is given up.
struct ImportLimits {
  std::int64_t memory_bytes = std::int64_t{4} << 30;  // of address space, > 0
  double time_s = 120.0;                              // > 0
};

struct ImportOptions {
  std::optional<core::LengthUnit> unit{};  // of the file's numbers; overrides what the file says
  std::optional<core::LengthUnit> unit_if_file_has_none{};  // when `unit` isn't given
  // > 0; how far triangles may be from the faces of STEP, IGES and BREP: this, or a thousandth of a body's
  // diagonal where that is less.
  double tolerance_mm = 0.2;
  ImportLimits limits{};

  // Throws: Error{kRange} naming the option that is out of range.
  void Validate() const;
};

}  // namespace elbowroom::cad_import
