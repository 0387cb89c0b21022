// Makes foreign texts (names in files, paths, messages of libraries) safe to show: on one line, without
// control characters.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace elbowroom::core {

// The longest message, in bytes of UTF-8. It has no more characters than that.
inline constexpr std::size_t kLongestMessageBytes = 300;

// Whether a text is UTF-8 without characters that end a line or steer a terminal: control characters (C0,
// DEL, C1), the separators of lines and paragraphs, and marks that turn the direction of what follows.
[[nodiscard]] bool IsPlain(std::string_view text);

// The text, with each byte of such a character and each byte that isn't UTF-8 written in hexadecimal, as in
// "\x1b".
[[nodiscard]] std::string MadeVisible(std::string_view text);

// The text, with one space for each such character and each such byte. For names.
[[nodiscard]] std::string Blanked(std::string_view text);

// MadeVisible, shortened to `most_bytes` (at least 20). First the longest words, which are mostly paths, lose
// their middles; then the whole line does. So a path's end and the advice after it stay. Throws:
// PreconditionError for fewer than 20 bytes.
[[nodiscard]] std::string OneLine(std::string_view text, std::size_t most_bytes = kLongestMessageBytes);

}  // namespace elbowroom::core
