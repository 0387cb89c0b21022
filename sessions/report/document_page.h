// A document as a page of its own.
#pragma once

#include <string>

#include "sessions/document/document.h"

namespace elbowroom::sessions {

// A complete HTML document that loads nothing. Its script draws the charts anew; without a script their
// pictures stay.
[[nodiscard]] std::string DocumentPage(const Document& document);

}  // namespace elbowroom::sessions
