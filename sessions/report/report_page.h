// The report's page.
#pragma once

#include <string>

#include "sessions/document/document.h"
#include "sessions/report/report_data.h"
#include "sessions/report/report_model.h"

namespace elbowroom::sessions {

// A complete HTML document that loads nothing. Its script draws what its pictures show anew; without a script
// or without WebGL the pictures stay.
[[nodiscard]] std::string ReportPage(const ReportData& data, const Document& document,
                                     const ReportModel& model);

}  // namespace elbowroom::sessions
