#include "sessions/report/report_page.h"

#include "sessions/report/document_html.h"
#include "sessions/report/html_page.h"
#include "sessions/report/markup.h"
#include "sessions/report/page_data.h"

namespace elbowroom::sessions {

std::string ReportPage(const ReportData& data, const Document& document, const ReportModel& model) {
  PageCharts charts;
  const std::string body = DocumentHtml(document, &charts);
  return HtmlPage(Escaped(document.title), body, PageDataJson(data, charts, model));
}

}  // namespace elbowroom::sessions
