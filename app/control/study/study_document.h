// What a study's report says.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "app/control/study/study.h"
#include "sessions/document/document.h"
#include "sessions/report/drawn_chart.h"

namespace elbowroom::control {

struct DwellPicture {
  std::string part;
  std::size_t sessions = 0;
  std::vector<std::uint8_t> png;
};

// The document's pictures are those of `dwell`. The same study and pictures give the same document.
// Throws: as sessions::Drawn.
[[nodiscard]] sessions::Document StudyDocument(const Study& study, const std::vector<DwellPicture>& dwell,
                                               sessions::ChartPainters* painters);

}  // namespace elbowroom::control
