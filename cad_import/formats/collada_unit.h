// The unit of a COLLADA document, as its text has it.
#pragma once

#include <string>

namespace elbowroom::cad_import {

// True if <unit meter="..."> is there but no positive number; it is then put to 1 in the text, as a file's
// numbers can't be had back once a reader has multiplied them by it. A decimal comma becomes a point, and
// blanks go.
bool MendUnit(std::string* document);

}  // namespace elbowroom::cad_import
