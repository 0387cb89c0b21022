#include "sessions/report/document_page.h"

#include "sessions/report/document_html.h"
#include "sessions/report/html_page.h"
#include "sessions/report/markup.h"
#include "sessions/report/page_data.h"

namespace elbowroom::sessions {

std::string DocumentPage(const Document& document) {
  PageCharts charts;
  const std::string body = DocumentHtml(document, &charts);
  return HtmlPage(Escaped(document.title), body, PageDataJson(charts));
}

}  // namespace elbowroom::sessions
