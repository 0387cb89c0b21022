// QUESTIONNAIRE.toml: items, scales, reversed ones, and the scores that are computed of the answers.
#pragma once

#include <filesystem>

#include "core/questionnaire.h"

namespace elbowroom::control {

// Reads the file (docs/questionnaires.md); `when` is the trial's to say. Throws: Error{kFile} where it can't
// be read; Error{kFormat} with file, line and key for what isn't as it must be.
[[nodiscard]] core::Questionnaire ReadQuestionnaireFile(const std::filesystem::path& path,
                                                        core::AskedWhen when);

}  // namespace elbowroom::control
