// A table as Markdown shows it.
#pragma once

#include <string>
#include <vector>

namespace elbowroom::reporting {

struct Table {
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows;  // as many cells as the header
};

// The first column to the left, all others to the right; a `|` in a cell is escaped.
// Throws: PreconditionError for a row of another length than the header's.
[[nodiscard]] std::string ToMarkdown(const Table& table);

// The first table in a text, as ToMarkdown writes it. Throws: core::Error{kFormat} where there is none, or a
// row is not as long as the header.
[[nodiscard]] Table TableOf(const std::string& markdown);

// Three significant digits without an exponent: 0.00123, 0.482, 12.7, 1230.
[[nodiscard]] std::string ThreeDigits(double value);

}  // namespace elbowroom::reporting
