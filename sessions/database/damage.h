// The error for a damaged session file, and text from such a file made fit for a message.
#pragma once

#include <string>
#include <string_view>

namespace elbowroom::sessions {

// Throws: Error{kFormat} in one line that says where, what is wrong there, and how to salvage the rest.
[[noreturn]] void FailAsDamaged(const std::string& where, std::string_view what);

// Text from a file, for a message: one line of valid UTF-8. Text that would take more than `most` bytes is
// cut and ends in an ellipsis.
[[nodiscard]] std::string Quotable(std::string_view text, std::size_t most = 80);

// The text with U+FFFD for every byte that belongs to no character.
[[nodiscard]] std::string AsUtf8(std::string text);

}  // namespace elbowroom::sessions
