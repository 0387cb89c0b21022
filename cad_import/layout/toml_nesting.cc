#include "cad_import/layout/toml_nesting.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>

#include "core/error.h"

namespace elbowroom::cad_import {
namespace {

constexpr int kDeepest = 64;
constexpr int kMostDots = 16;

// Where the string that begins at `at` ends; at a line break for one of a single line that isn't closed.
std::size_t EndOfString(std::string_view text, std::size_t at) {
  const char quote = text[at];
  const bool has_escapes = quote == '"';
  const bool is_long = text.substr(at, 3) == std::string(3, quote);
  const std::string_view close = text.substr(at, is_long ? 3 : 1);
  for (at += close.size(); at < text.size(); ++at) {
    if (has_escapes && text[at] == '\\') {
      ++at;
    } else if (text.substr(at).starts_with(close)) {
      return at + close.size();
    } else if (!is_long && text[at] == '\n') {
      return at;
    }
  }
  return text.size();
}

}  // namespace

void RefuseDeepToml(std::string_view text, const std::string& file) {
  int depth = 0, dots = 0;
  for (std::size_t at = 0; at < text.size(); ++at) {
    switch (text[at]) {
      case '#':
        at = std::min(text.find('\n', at), text.size()) - 1;
        break;
      case '"':
      case '\'':
        at = EndOfString(text, at) - 1;
        break;
      case '[':
      case '{':
        ++depth;
        dots = 0;
        break;
      case ']':
      case '}':
        depth = std::max(0, depth - 1);
        dots = 0;
        break;
      case ',':
      case '=':
      case '\n':
        dots = 0;
        break;
      case '.':
        ++dots;
        break;
      default:
        break;
    }
    if (depth <= kDeepest && dots <= kMostDots) continue;
    const auto line = 1 + std::ranges::count(text.substr(0, at), '\n');
    throw core::Error(core::ErrorKind::kFormat,
                      fmt::format("{}:{}: nested too deep ({} lists and tables, or keys of {} parts, are the "
                                  "most); remove what doesn't belong here",
                                  file, line, kDeepest, kMostDots + 1));
  }
}

}  // namespace elbowroom::cad_import
