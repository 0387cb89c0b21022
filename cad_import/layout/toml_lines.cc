#include "cad_import/layout/toml_lines.h"

#include <algorithm>

namespace elbowroom::cad_import {
namespace {

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
constexpr std::string_view kBlanks = " \t\r\n";

// The first character that isn't blank, or 0.
char FirstOf(std::string_view line) {
  const std::size_t at = line.find_first_not_of(kBlanks);
  return at == std::string_view::npos ? '\0' : line[at];
}

bool IsWithinCharacter(char byte) { return (static_cast<unsigned char>(byte) & 0xC0U) == 0x80U; }

bool SayTheSame(const toml::array& a, const toml::array& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const toml::node& x, const toml::node& y) { return SaysTheSame(x, y); });
}

bool SayTheSame(const toml::table& a, const toml::table& b) {
  return a.size() == b.size() && std::all_of(a.begin(), a.end(), [&](const auto& key_and_value) {
           const toml::node* other = b.get(key_and_value.first.str());
           return other != nullptr && SaysTheSame(key_and_value.second, *other);
         });
}

}  // namespace

TomlLines::TomlLines(std::string_view text, const toml::table& document) : text_(text) {
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size() - 1) + 1;
    lines_.push_back(text.substr(at, end - at));
    at = end;
  }
  if (!lines_.empty() && text.starts_with(kByteOrderMark)) lines_[0].remove_prefix(kByteOrderMark.size());
  goes_on_.assign(lines_.size(), false);
  MarkValues(document);
}

void TomlLines::MarkValues(const toml::node& node) {
  if (const toml::table* table = node.as_table()) {
    for (const auto& [key, value] : *table) MarkValues(value);
    return;
  }
  if (node.is_array_of_tables()) {
    for (const toml::node& table : *node.as_array()) MarkValues(table);
    return;
  }
  for (std::size_t line = node.source().begin.line; line < node.source().end.line; ++line)
    goes_on_[line] = true;
}

std::string_view TomlLines::Text(const LineRange& range) const {
  return text_.substr(Start(range.first), Start(range.last + 1) - Start(range.first));
}

bool TomlLines::IsBlank(std::size_t line) const {
  return !goes_on_[line] && lines_[line].find_first_not_of(kBlanks) == std::string_view::npos;
}

bool TomlLines::IsComment(std::size_t line) const { return !goes_on_[line] && FirstOf(lines_[line]) == '#'; }

bool TomlLines::IsHeader(std::size_t line) const { return !goes_on_[line] && FirstOf(lines_[line]) == '['; }

std::string_view TomlLines::Indent(std::size_t line) const {
  return lines_[line].substr(0, std::min(lines_[line].find_first_not_of(" \t"), lines_[line].size()));
}

std::size_t TomlLines::Start(std::size_t line) const {
  return line == lines_.size() ? text_.size() : static_cast<std::size_t>(lines_[line].data() - text_.data());
}

std::size_t TomlLines::Offset(const toml::source_position& at) const {
  const std::string_view line = lines_[at.line - 1];
  std::size_t byte = 0;
  for (toml::source_index column = 1; column < at.column && byte < line.size(); ++column) {
    do {
      ++byte;
    } while (byte < line.size() && IsWithinCharacter(line[byte]));
  }
  return Start(at.line - 1) + byte;
}

LineRange TomlLines::LinesOf(const toml::table& entry) const {
  LineRange own{entry.source().begin.line - 1, LastLineOf(entry) - 1};
  std::size_t above = own.first;
  while (above > 0 && IsComment(above - 1)) --above;
  if (above > 0) own.first = above;
  std::size_t below = own.last;
  while (below + 1 < size() && IsComment(below + 1)) ++below;
  if (below + 1 == size() || !IsHeader(below + 1)) own.last = below;
  return own;
}

std::string_view TomlLines::EndOfLine() const {
  return text_.find("\r\n") == std::string_view::npos ? "\n" : "\r\n";
}

toml::source_index LastLineOf(const toml::node& node) {
  toml::source_index last = node.source().end.line;
  if (const toml::table* table = node.as_table())
    for (const auto& [key, value] : *table) last = std::max(last, LastLineOf(value));
  return last;
}

bool SaysTheSame(const toml::node& a, const toml::node& b) {
  if (a.is_number() && b.is_number()) return a.value<double>() == b.value<double>();
  if (a.is_array() && b.is_array()) return SayTheSame(*a.as_array(), *b.as_array());
  if (a.is_table() && b.is_table()) return SayTheSame(*a.as_table(), *b.as_table());
  if (a.is_string() && b.is_string()) return a.value<std::string_view>() == b.value<std::string_view>();
  return a.is_boolean() && b.is_boolean() && a.value<bool>() == b.value<bool>();
}

}  // namespace elbowroom::cad_import
