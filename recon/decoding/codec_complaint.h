// Finds complaints about damaged files in the text that codecs print.
#pragma once

#include <string>
#include <string_view>

namespace elbowroom::recon {

// The first line of `printed` that may tell of damage to pixels, without its prefix, of at most 100 bytes; ""
// if there is none. Any line counts but OpenCV's own log and those known to be harmless, such as unknown TIFF
// tags.
[[nodiscard]] std::string ComplaintIn(std::string_view printed);

}  // namespace elbowroom::recon
