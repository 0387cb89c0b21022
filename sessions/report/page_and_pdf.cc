#include "sessions/report/page_and_pdf.h"

#include "core/error.h"
#include "sessions/print/pdf.h"
#include "sessions/report/document_page.h"

namespace elbowroom::sessions {

PageAndPdf MakePageAndPdf(const Document& document, const core::Progress& progress,
                          const std::stop_token& stop) {
  core::ThrowIfStopped(stop, "the report");
  progress.Report(0, 2, "writing the report");
  PageAndPdf both{DocumentPage(document), {}};
  core::ThrowIfStopped(stop, "the report");
  progress.Report(1, 2, "writing the report");
  both.pdf = PdfOf(document);
  core::ThrowIfStopped(stop, "the report");
  return both;
}

}  // namespace elbowroom::sessions
