// A document as a page and as a PDF.
#pragma once

#include <stop_token>
#include <string>

#include "core/progress.h"
#include "sessions/document/document.h"

namespace elbowroom::sessions {

struct PageAndPdf {
  std::string html;  // complete; it loads nothing
  std::string pdf;   // bytes
};

// Throws: core::Error{kCancelled}; as PdfOf (pdf.h).
[[nodiscard]] PageAndPdf MakePageAndPdf(const Document& document, const core::Progress& progress,
                                        const std::stop_token& stop);

}  // namespace elbowroom::sessions
