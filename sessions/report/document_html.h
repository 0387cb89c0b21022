// A document as a page's body.
#pragma once

#include <string>

#include "sessions/document/document.h"
#include "sessions/report/page_charts.h"

namespace elbowroom::sessions {

// HTML: the document's header, sections and footer. Every text is escaped.
[[nodiscard]] std::string DocumentHtml(const Document& document, PageCharts* charts);

}  // namespace elbowroom::sessions
