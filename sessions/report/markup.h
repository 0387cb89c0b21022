// Text and pictures made safe for a page.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace elbowroom::sessions {

// Safe between tags and in quoted attributes; control characters but tab and newline become spaces.
[[nodiscard]] std::string Escaped(std::string_view text);

// RFC 4648.
[[nodiscard]] std::string Base64(std::span<const unsigned char> bytes);

// "data:image/png;base64,...".
[[nodiscard]] std::string PngAsDataUrl(std::span<const unsigned char> png);

}  // namespace elbowroom::sessions
