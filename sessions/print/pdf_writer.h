// Pages as the bytes of a PDF.
#pragma once

#include <string>

#include "sessions/document/document.h"
#include "sessions/print/printer.h"

namespace elbowroom::sessions {

// As PdfOf (pdf.h).
[[nodiscard]] std::string WritePdf(const Document& document, const InkColors& inks);

}  // namespace elbowroom::sessions
