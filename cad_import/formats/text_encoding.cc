#include "cad_import/formats/text_encoding.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace elbowroom::cad_import {
namespace {

constexpr std::uint32_t kNoCharacter = 0xFFFD;
constexpr std::uint32_t kLargestCharacter = 0x10FFFF;

struct TextEncoding {
  std::size_t unit_bytes = 2;
  bool is_big_endian = false;
};

std::optional<TextEncoding> EncodingOf(std::string_view bytes) {
  using namespace std::string_view_literals;
  // The mark of UTF-16 begins that of UTF-32.
  if (bytes.starts_with("\xFF\xFE\0\0"sv)) return TextEncoding{4, false};
  if (bytes.starts_with("\0\0\xFE\xFF"sv)) return TextEncoding{4, true};
  if (bytes.starts_with("\xFF\xFE"sv)) return TextEncoding{2, false};
  if (bytes.starts_with("\xFE\xFF"sv)) return TextEncoding{2, true};
  return std::nullopt;
}

// Takes the next unit off; kNoCharacter for an incomplete one.
std::uint32_t TakeUnit(std::string_view& bytes, const TextEncoding& encoding) {
  std::uint32_t unit = 0;
  const std::string_view taken = bytes.substr(0, encoding.unit_bytes);
  bytes.remove_prefix(taken.size());
  if (taken.size() < encoding.unit_bytes) return kNoCharacter;
  for (std::size_t i = 0; i < taken.size(); ++i) {
    const std::size_t from = encoding.is_big_endian ? i : taken.size() - 1 - i;
    unit = unit << 8U | static_cast<unsigned char>(taken[from]);
  }
  return unit;
}

bool IsHigh(std::uint32_t unit) { return unit >= 0xD800 && unit < 0xDC00; }
bool IsLow(std::uint32_t unit) { return unit >= 0xDC00 && unit < 0xE000; }

std::uint32_t TakeCharacter(std::string_view& bytes, const TextEncoding& encoding) {
  const std::uint32_t unit = TakeUnit(bytes, encoding);
  if (encoding.unit_bytes == 2 && IsHigh(unit)) {
    std::string_view after = bytes;
    const std::uint32_t low = TakeUnit(after, encoding);
    if (!IsLow(low)) return kNoCharacter;
    bytes = after;
    return 0x10000 + ((unit - 0xD800) << 10U) + (low - 0xDC00);
  }
  return IsHigh(unit) || IsLow(unit) || unit > kLargestCharacter ? kNoCharacter : unit;
}

void AppendUtf8(std::uint32_t character, std::string& text) {
  const auto append = [&](std::uint32_t byte) { text += static_cast<char>(byte); };
  if (character < 0x80) return append(character);
  if (character < 0x800) {
    append(0xC0 | character >> 6U);
  } else {
    if (character < 0x10000) {
      append(0xE0 | character >> 12U);
    } else {
      append(0xF0 | character >> 18U);
      append(0x80 | (character >> 12U & 0x3FU));
    }
    append(0x80 | (character >> 6U & 0x3FU));
  }
  append(0x80 | (character & 0x3FU));
}

}  // namespace

std::string ToUtf8(std::string bytes) {
  const std::optional<TextEncoding> encoding = EncodingOf(bytes);
  if (!encoding) return bytes;
  std::string_view rest = bytes;
  rest.remove_prefix(encoding->unit_bytes);
  std::string text;
  text.reserve(rest.size());
  while (!rest.empty()) AppendUtf8(TakeCharacter(rest, *encoding), text);
  return text;
}

}  // namespace elbowroom::cad_import
