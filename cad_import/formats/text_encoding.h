// Text in whatever Unicode encoding, as parsers take it.
#pragma once

#include <string>

namespace elbowroom::cad_import {

// UTF-16 or UTF-32, as its byte order mark says, as UTF-8 without a mark; all else as it is. What is no
// character (half a pair, an odd byte at the end) becomes U+FFFD.
[[nodiscard]] std::string ToUtf8(std::string bytes);

}  // namespace elbowroom::cad_import
