// A study's report as a page and as a PDF.
#pragma once

#include <stop_token>
#include <string>

#include "app/control/study/study.h"
#include "core/progress.h"

namespace elbowroom::control {

struct StudyReport {
  std::string html;  // complete; it loads nothing
  std::string pdf;   // bytes
};

// With a picture of each of the parts that were touched longest; kMostDwellPictures of them.
// Throws: core::Error{kGraphics, kCancelled}; as sessions::PdfOf. Thread: any, one at a time.
inline constexpr std::size_t kMostDwellPictures = 8;
[[nodiscard]] StudyReport MakeStudyReport(const Study& study, const core::Progress& progress,
                                          const std::stop_token& stop);

}  // namespace elbowroom::control
