// The unit of a COLLADA document, as its text has it.
#pragma once

#include <string>

namespace elbowroom::cad_import {

// Mends the number in <unit meter="...">: a decimal comma becomes a point, blanks go, and what isn't a
// positive number becomes 1. True in this last case. Readers multiply all lengths by the number, and they
// couldn't be recovered afterwards.
bool MendUnit(std::string* document);

}  // namespace elbowroom::cad_import
