// What codecs print when a file is damaged, told from what else they print.
#pragma once

#include <string>
#include <string_view>

namespace elbowroom::recon {

// The first line of `printed` that tells of damage to pixels, without its prefix, short enough for a message;
// "" if there is none. Known harmless: OpenCV's own log, TIFF tags that nobody knows.
[[nodiscard]] std::string ComplaintIn(std::string_view printed);

}  // namespace elbowroom::recon
