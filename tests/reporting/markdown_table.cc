#include "tests/reporting/markdown_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

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

}  // namespace

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
