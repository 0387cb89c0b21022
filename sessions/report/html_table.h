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

  // One HTML cell a column.
  void Add(const std::vector<std::string>& cells, const std::string& css_class = "");
  [[nodiscard]] bool empty() const { return rows_.empty(); }
  [[nodiscard]] std::string Html() const;

 private:
  std::vector<TableColumn> columns_;
  std::string rows_;
};

}  // namespace elbowroom::sessions
