#include "tests/reporting/markdown_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "core/error.h"

namespace elbowroom::reporting {
namespace {

std::string Row(const std::vector<std::string>& cells) {
  std::string line = "|";
  for (const std::string& cell : cells) {
    line += ' ';
    for (const char c : cell) line += c == '|' ? std::string("\\|") : std::string(1, c);
    line += " |";
  }
  return line + '\n';
}

// The cells of a line that is a row: between unescaped bars, without the spaces around.
std::vector<std::string> CellsOf(const std::string& line) {
  std::vector<std::string> cells(1);
  for (std::size_t i = 1; i < line.size(); ++i) {
    const bool is_escaped = line[i] == '\\' && i + 1 < line.size() && line[i + 1] == '|';
    if (is_escaped) {
      cells.back() += line[++i];
    } else if (line[i] == '|') {
      cells.emplace_back();
    } else {
      cells.back() += line[i];
    }
  }
  cells.pop_back();  // behind the last bar
  for (std::string& cell : cells) {
    const std::size_t begin = cell.find_first_not_of(' '), end = cell.find_last_not_of(' ');
    cell = begin == std::string::npos ? "" : cell.substr(begin, end - begin + 1);
  }
  return cells;
}

}  // namespace

Table TableOf(const std::string& markdown) {
  std::vector<std::vector<std::string>> rows;
  std::istringstream lines(markdown);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with('|')) {
      rows.push_back(CellsOf(line));
    } else if (!rows.empty()) {
      break;
    }
  }
  const bool is_table = rows.size() >= 2 && std::ranges::all_of(rows, [&](const auto& row) {
                          return row.size() == rows.front().size();
                        });
  if (!is_table) {
    throw core::Error(core::ErrorKind::kFormat,
                      "there is no whole table where one is expected; measure it anew with ./dev bench");
  }
  return {rows.front(), {rows.begin() + 2, rows.end()}};
}

std::string ToMarkdown(const Table& table) {
  std::vector<std::string> rule(table.header.size(), "---:");
  if (!rule.empty()) rule.front() = "---";
  std::string text = Row(table.header) + Row(rule);
  for (const std::vector<std::string>& row : table.rows) {
    core::Require(row.size() == table.header.size(), "a table's rows have its header's length");
    text += Row(row);
  }
  return text;
}

std::string ThreeDigits(double value) {
  if (value == 0.0 || !std::isfinite(value)) return fmt::format("{}", value);
  const int digits_before = static_cast<int>(std::floor(std::log10(std::abs(value)))) + 1;
  const int after = std::max(0, 3 - digits_before);
  const double unit = std::pow(10.0, 3 - digits_before);
  return fmt::format("{:.{}f}", digits_before > 3 ? std::round(value * unit) / unit : value, after);
}

}  // namespace elbowroom::reporting
