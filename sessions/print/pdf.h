// A document on paper.
#pragma once

#include <string>

#include "sessions/document/document.h"

namespace elbowroom::sessions {

// The bytes of a PDF on A4: text that can be searched, charts as vectors, an outline of the sections, page
// numbers. A row of a table stands whole on a page where a page can hold it, below the table's head; names
// break at any letter before they are cut. What is for screens is left out. Text that is no UTF-8 becomes
// U+FFFD, control characters become spaces. The same document gives the same bytes on the same machine (its
// fonts).
// Throws: Error{kFile} if the printer can't be loaded or no font is installed; PreconditionError for pictures
// that are no PNG. Thread: any.
[[nodiscard]] std::string PdfOf(const Document& document);

}  // namespace elbowroom::sessions
