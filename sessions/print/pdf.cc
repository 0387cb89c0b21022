#include "sessions/print/pdf.h"

#include "sessions/charts/ink.h"
#include "sessions/print/printer.h"

namespace elbowroom::sessions {

std::string PdfOf(const Document& document) { return LoadedPrinter().pdf(document, InksOnPaper()); }

}  // namespace elbowroom::sessions
