// What a trial file says of its procedure: condition, order, [[step]], [[survey]].
#pragma once

#include "cad_import/layout/toml_entry.h"
#include "core/session.h"

namespace elbowroom::control {

// Reads `condition`, `order`, [[step]] `name`, and [[survey]] `when`, `item`, `scale` (docs/user_guide.md)
// into the trial. Throws: Error{kFormat} with file, line and key for what isn't as it must be.
void ReadProcedure(const cad_import::TomlEntry& root, core::TrialInfo* trial);

}  // namespace elbowroom::control
