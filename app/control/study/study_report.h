// A study's report as a page and as a PDF.
#pragma once

#include <stop_token>

#include "app/control/study/study.h"
#include "core/progress.h"
#include "sessions/report/page_and_pdf.h"

namespace elbowroom::control {

// With a picture of each of the parts that were touched longest; kMostDwellPictures of them.
// Throws: core::Error{kGraphics, kCancelled}; as sessions::MakePageAndPdf. Thread: any, one at a time.
inline constexpr std::size_t kMostDwellPictures = 8;
[[nodiscard]] sessions::PageAndPdf MakeStudyReport(const Study& study, const core::Progress& progress,
                                                   const std::stop_token& stop);

}  // namespace elbowroom::control
