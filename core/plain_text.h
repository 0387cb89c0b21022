// Texts of others (names in files, paths, what a library says) as they may be shown: on one line, in one
// piece.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace elbowroom::core {

// The longest message, in bytes of UTF-8, so that it is never more characters.
inline constexpr std::size_t kLongestMessageBytes = 300;

// Whether a text is UTF-8 without characters that end a line or steer a terminal: control characters (C0,
// DEL, C1), the separators of lines and paragraphs, and marks that turn the direction of what follows.
[[nodiscard]] bool IsPlain(std::string_view text);

// The same text with every byte of such a character, and every byte that isn't UTF-8, written as "\x1b".
[[nodiscard]] std::string MadeVisible(std::string_view text);

// The same text with a space for each of them: for names.
[[nodiscard]] std::string Blanked(std::string_view text);

// MadeVisible, in at most `most_bytes` (at least 20): the longest words, which are paths, lose their middles
// first, then the whole its own, so that the path's end and the advice after it stay.
[[nodiscard]] std::string OneLine(std::string_view text, std::size_t most_bytes = kLongestMessageBytes);

}  // namespace elbowroom::core
