// What the page's script reads.
#pragma once

#include <string>
#include <vector>

#include "sessions/report/page_charts.h"
#include "sessions/report/report_data.h"
#include "sessions/report/report_model.h"

namespace elbowroom::sessions {

// JSON in ASCII without "<", so that nothing in it ends the element that it stands in; bytes that are no
// UTF-8 become U+FFFD. {charts, touches, names, first_touch, model}, as web/page/report.js takes it.
[[nodiscard]] std::string PageDataJson(const ReportData& data, const PageCharts& charts,
                                       const ReportModel& model);

// Of a page with neither touches nor a model.
[[nodiscard]] std::string PageDataJson(const PageCharts& charts);

// The statuses that the listed touches have, in order of their names.
[[nodiscard]] std::vector<std::string> StatusesOf(const ReportData& data);

}  // namespace elbowroom::sessions
