// A trial's questionnaires as rows: questions, scores, and which questions a score counts.
#pragma once

#include <vector>

#include "core/questionnaire.h"
#include "sessions/database/database.h"

namespace elbowroom::sessions {

// The tables are empty. Throws: Error{kDatabase}.
void InsertQuestionnaires(Database& database, const std::vector<core::Questionnaire>& questionnaires);

// Throws: Error{kDatabase}; Error{kFormat} where a row is damaged.
[[nodiscard]] std::vector<core::Questionnaire> ReadQuestionnaires(Database& database);

}  // namespace elbowroom::sessions
