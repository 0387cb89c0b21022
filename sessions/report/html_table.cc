#include "sessions/report/html_table.h"

#include <fmt/format.h>

#include "core/error.h"

namespace elbowroom::sessions {

void HtmlTable::Add(const std::vector<std::string>& cells, const std::string& css_class,
                    const std::string& attributes) {
  core::Require(cells.size() == columns_.size(), "a row has one cell a column");
  rows_ +=
      fmt::format("<tr{}{}>", css_class.empty() ? "" : fmt::format(" class='{}'", css_class), attributes);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    rows_ += fmt::format("<td{}>{}</td>", columns_[i].is_number ? " class='n'" : "", cells[i]);
  }
  rows_ += "</tr>\n";
}

void HtmlTable::BeginGroup(const std::string& html) {
  if (!rows_.empty()) rows_ += "</tbody><tbody>";
  rows_ += fmt::format("<tr class='group'><th colspan='{}' scope='rowgroup'>{}</th></tr>\n", columns_.size(),
                       html);
}

std::string HtmlTable::Html() const {
  std::string titles;
  for (const TableColumn& column : columns_) {
    titles += fmt::format("<th{}>{}</th>", column.is_number ? " class='n'" : "", column.title);
  }
  return "<div class='scroll'><table><thead><tr>" + titles + "</tr></thead>\n<tbody>" + rows_ +
         "</tbody></table></div>\n";
}

}  // namespace elbowroom::sessions
