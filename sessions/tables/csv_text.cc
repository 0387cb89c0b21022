#include "sessions/tables/csv_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>

namespace elbowroom::sessions {

namespace {

// Whether a spreadsheet may take the text for a formula. Japanese spreadsheets know the full-width signs as
// well.
bool BeginsFormula(std::string_view text) {
  constexpr std::string_view kBeginnings[] = {
      "=", "+", "-", "@", "\xEF\xBC\x9D", "\xEF\xBC\x8B", "\xEF\xBC\x8D", "\xEF\xBC\xA0"};
  return std::ranges::any_of(kBeginnings, [&](std::string_view begin) { return text.starts_with(begin); });
}

// Whether a spreadsheet that doesn't split lines at commas alone may begin a cell after the character.
bool MayEndCell(char c) { return c == ';' || c == '\t' || c == '\r' || c == '\n' || c == '"' || c == '\''; }

// Puts an apostrophe before each place where a spreadsheet may see a formula: it then shows the text
// unchanged.
std::string Neutralised(std::string_view text) {
  std::string plain;
  if (text.starts_with('\t') || text.starts_with('\r') || text.starts_with('\n')) plain += '\'';
  bool begins_cell = true;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (begins_cell && BeginsFormula(text.substr(i))) plain += '\'';
    plain += text[i];
    begins_cell = MayEndCell(text[i]) || (begins_cell && text[i] == ' ');
  }
  return plain;
}

}  // namespace

std::string Quoted(std::string_view text) {
  std::string plain = Neutralised(text);
  if (plain == text && text.find_first_of(",;\t\"\r\n") == std::string_view::npos) return plain;
  std::string quoted = "\"";
  for (const char c : plain) {
    if (c == '"') quoted += '"';
    quoted += c;
  }
  return quoted + '"';
}

void AppendVector(std::string& line, const std::optional<Eigen::Vector3d>& vector) {
  line += vector ? fmt::format(",{},{},{}", vector->x(), vector->y(), vector->z()) : ",,,";
}

}  // namespace elbowroom::sessions
