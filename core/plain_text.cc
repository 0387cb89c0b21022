#include "core/plain_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <optional>

#include "core/error.h"

namespace elbowroom::core {
namespace {

constexpr std::string_view kEllipsis = "…";

struct Character {
  std::uint32_t code = 0;
  std::size_t bytes = 1;
};

bool IsContinuation(char c) { return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U; }

// The character that a text begins with; nothing where it isn't UTF-8 (RFC 3629, section 4).
std::optional<Character> FirstCharacter(std::string_view text) {
  const auto lead = static_cast<unsigned char>(text.front());
  if (lead < 0x80) return Character{lead, 1};
  const std::size_t bytes = lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : 2;
  if (lead < 0xC2 || lead > 0xF4 || text.size() < bytes) return std::nullopt;
  std::uint32_t code = lead & (0xFFU >> (bytes + 1));
  for (std::size_t i = 1; i < bytes; ++i) {
    if (!IsContinuation(text[i])) return std::nullopt;
    code = code << 6U | (static_cast<unsigned char>(text[i]) & 0x3FU);
  }
  constexpr std::uint32_t kFirstOf[] = {0, 0, 0x80, 0x800, 0x10000};  // smaller codes take fewer bytes
  const bool is_surrogate = code >= 0xD800 && code <= 0xDFFF;
  if (code < kFirstOf[bytes] || is_surrogate || code > 0x10FFFF) return std::nullopt;
  return Character{code, bytes};
}

bool SteersTheReader(std::uint32_t code) {
  if (code < 0x20 || (code >= 0x7F && code < 0xA0)) return true;  // C0, DEL, C1
  if (code == 0x2028 || code == 0x2029) return true;              // separators of lines and paragraphs
  return (code >= 0x202A && code <= 0x202E) || (code >= 0x2066 && code <= 0x2069);  // turns of direction
}

// How many bytes at the text's beginning are plain, and how many belong to the next thing that isn't.
struct Stretch {
  std::size_t plain = 0;
  std::size_t other = 0;
};
Stretch NextStretch(std::string_view text) {
  Stretch stretch;
  while (stretch.plain < text.size()) {
    const std::optional<Character> character = FirstCharacter(text.substr(stretch.plain));
    if (!character || SteersTheReader(character->code)) {
      stretch.other = character ? character->bytes : 1;
      break;
    }
    stretch.plain += character->bytes;
  }
  return stretch;
}

template <typename Append>
std::string Replaced(std::string_view text, Append append) {
  std::string plain;
  while (!text.empty()) {
    const Stretch stretch = NextStretch(text);
    plain += text.substr(0, stretch.plain);
    append(plain, text.substr(stretch.plain, stretch.other));
    text.remove_prefix(stretch.plain + stretch.other);
  }
  return plain;
}

// The text without its middle, cut between characters, with an ellipsis in its place.
std::string WithoutMiddle(std::string_view text, std::size_t most_bytes) {
  if (text.size() <= most_bytes) return std::string(text);
  const std::size_t kept = most_bytes - kEllipsis.size();
  std::size_t head = kept * 2 / 5, tail = text.size() - (kept - head);
  while (head > 0 && IsContinuation(text[head])) --head;
  while (tail < text.size() && IsContinuation(text[tail])) ++tail;
  return std::string(text.substr(0, head)).append(kEllipsis).append(text.substr(tail));
}

std::string_view LongestWord(std::string_view line) {
  std::string_view longest;
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t end = std::min(line.find(' ', begin), line.size());
    if (end - begin > longest.size()) longest = line.substr(begin, end - begin);
    begin = end + 1;
  }
  return longest;
}

}  // namespace

bool IsPlain(std::string_view text) { return NextStretch(text).plain == text.size(); }

std::string MadeVisible(std::string_view text) {
  return Replaced(text, [](std::string& plain, std::string_view bytes) {
    for (const char byte : bytes) plain += fmt::format("\\x{:02x}", static_cast<unsigned char>(byte));
  });
}

std::string Blanked(std::string_view text) {
  return Replaced(text, [](std::string& plain, std::string_view bytes) {
    if (!bytes.empty()) plain += ' ';
  });
}

std::string OneLine(std::string_view text, std::size_t most_bytes) {
  constexpr std::size_t kLeast = 20, kMostLookedAt = 65'536, kShortWord = 24;
  Require(most_bytes >= kLeast, "a line of at least 20 bytes");
  std::string line = MadeVisible(WithoutMiddle(text, kMostLookedAt));
  while (line.size() > most_bytes) {
    const std::string_view word = LongestWord(line);
    if (word.size() <= kShortWord) return WithoutMiddle(line, most_bytes);
    const std::size_t excess = line.size() - most_bytes;
    const std::size_t room = std::max(kShortWord, word.size() - std::min(excess, word.size()));
    line.replace(static_cast<std::size_t>(word.data() - line.data()), word.size(), WithoutMiddle(word, room));
  }
  return line;
}

}  // namespace elbowroom::core
