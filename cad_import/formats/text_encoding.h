// Text of any Unicode encoding as UTF-8.
#pragma once

#include <string>

namespace elbowroom::cad_import {

// Converts text with the byte order mark of UTF-16 or UTF-32 into UTF-8 without a mark. All other text stays
// as it is. What is no character (half a pair, an odd byte at the end) becomes U+FFFD.
[[nodiscard]] std::string ToUtf8(std::string bytes);

}  // namespace elbowroom::cad_import
