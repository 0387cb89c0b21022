// A table of a page, row by row.
#pragma once

#include <string>
#include <vector>

namespace elbowroom::sessions {

struct TableColumn {
  std::string title;       // HTML
  bool is_number = false;  // aligned to the right
};

class HtmlTable {
 public:
  explicit HtmlTable(std::vector<TableColumn> columns) : columns_(std::move(columns)) {}

  // One HTML cell a column. `attributes` of the row: " data-part='3'".
  void Add(const std::vector<std::string>& cells, const std::string& css_class = "",
           const std::string& attributes = "");
  // What follows stands below this HTML, as one body of the table.
  void BeginGroup(const std::string& html);
  [[nodiscard]] bool empty() const { return rows_.empty(); }
  [[nodiscard]] std::string Html() const;

 private:
  std::vector<TableColumn> columns_;
  std::string rows_;
};

}  // namespace elbowroom::sessions
