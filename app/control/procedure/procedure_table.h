// What a trial file says of its procedure: condition, order, block, [[step]], [[survey]].
#pragma once

#include <filesystem>

#include "cad_import/layout/toml_entry.h"
#include "core/session.h"

namespace elbowroom::control {

// Reads `condition`, `order`, `block`, [[step]] `name`, and [[survey]] `when` with `item` and `scale`, or
// with `file`, a questionnaire's from `folder` (docs/user_guide.md), into the trial. Throws: Error{kFormat}
// with file, line and key for what isn't as it must be; what ReadQuestionnaireFile throws.
void ReadProcedure(const cad_import::TomlEntry& root, const std::filesystem::path& folder,
                   core::TrialInfo* trial);

// What a file with a `base` says itself holds instead of what the trial has. Throws: likewise.
void ReadPlanned(const cad_import::TomlEntry& planned, core::TrialInfo* trial);

}  // namespace elbowroom::control
