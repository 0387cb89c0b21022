// The lines of a TOML document, and where its values stand in them.
#pragma once

#include <toml++/toml.h>

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace elbowroom::cad_import {

// Lines count from 0 here; toml++ counts them, and the characters in them, from 1.
struct LineRange {
  std::size_t first = 0;
  std::size_t last = 0;  // included
};

// The lines of one text. The text must not change, and must outlive this.
class TomlLines {
 public:
  TomlLines(std::string_view text, const toml::table& document);

  [[nodiscard]] std::size_t size() const { return lines_.size(); }
  [[nodiscard]] std::string_view operator[](std::size_t line) const { return lines_[line]; }
  [[nodiscard]] std::string_view Text(const LineRange& range) const;

  [[nodiscard]] bool IsBlank(std::size_t line) const;
  [[nodiscard]] bool IsComment(std::size_t line) const;  // false within a text of many lines
  [[nodiscard]] bool IsHeader(std::size_t line) const;   // begins with '[', and isn't within a value
  [[nodiscard]] std::string_view Indent(std::size_t line) const;

  // Bytes from the text's start.
  [[nodiscard]] std::size_t Start(std::size_t line) const;  // `line` may be size()
  [[nodiscard]] std::size_t Offset(const toml::source_position& at) const;

  // The lines that a table's header, keys and values are on, with the comments that belong to it: those right
  // above it, unless the file begins with them, and right below it, unless another header follows them.
  [[nodiscard]] LineRange LinesOf(const toml::table& entry) const;

  [[nodiscard]] std::string_view EndOfLine() const;  // "\n", or "\r\n" where the text has such

 private:
  void MarkValues(const toml::node& node);

  std::string_view text_;
  std::vector<std::string_view> lines_;  // each with its end
  std::vector<bool> goes_on_;            // a value that began on an earlier line reaches into it
};

// The line that a node ends on, in toml++'s count; for a table that of the last of its values.
[[nodiscard]] toml::source_index LastLineOf(const toml::node& node);

// Whether both have the same values. Whole numbers may be written as 12 or as 12.0.
[[nodiscard]] bool SaysTheSame(const toml::node& a, const toml::node& b);

}  // namespace elbowroom::cad_import
