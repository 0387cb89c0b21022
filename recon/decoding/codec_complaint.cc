#include "recon/decoding/codec_complaint.h"

#include <algorithm>
#include <array>

#include "core/system/child_process.h"

namespace elbowroom::recon {
namespace {

constexpr std::size_t kMostBytes = 100;

bool ContainsAny(std::string_view line, const auto& words) {
  return std::ranges::any_of(
      words, [&](std::string_view word) { return line.find(word) != std::string_view::npos; });
}

// OpenCV's log: "[ INFO:0@0.008] global ./modules/...". FFmpeg's is "[OPENCV:FFMPEG:16] ...".
bool IsLog(std::string_view line) {
  constexpr std::array<std::string_view, 5> kLevels{"[DEBUG:", "[ INFO:", "[ WARN:", "[ERROR:", "[FATAL:"};
  return std::ranges::any_of(kLevels, [&](std::string_view level) { return line.starts_with(level); });
}

// The place in OpenCV's source where decoding failed: of no use to users.
bool IsPlaceInOpenCv(std::string_view line) { return line.starts_with("imdecode_("); }

// Lines about other contents of the file, which don't concern its pixels.
bool IsHarmless(std::string_view line) {
  constexpr std::array<std::string_view, 3> kHarmless{
      "Unknown field with tag",        // libtiff: a camera's own notes
      "does not end in null byte",     // libtiff: of a text
      "deprecated pixel format used",  // swscale
  };
  return ContainsAny(line, kHarmless);
}

std::string_view WithoutPrefix(std::string_view line) {
  constexpr std::array<std::string_view, 4> kPrefixes{"[OPENCV:FFMPEG:16] ", "[OPENCV:FFMPEG:08] ",
                                                      "OpenCV TIFF: ", "libpng "};
  for (const std::string_view prefix : kPrefixes)
    if (line.starts_with(prefix)) line.remove_prefix(prefix.size());
  return line;
}

}  // namespace

std::string ComplaintIn(std::string_view printed) {
  while (!printed.empty()) {
    const std::size_t end = std::min(printed.find('\n'), printed.size());
    const std::string_view line = printed.substr(0, end);
    printed.remove_prefix(std::min(end + 1, printed.size()));
    const bool is_blank = std::ranges::all_of(line, [](char c) { return c == ' ' || c == '\0'; });
    if (is_blank || IsLog(line) || IsPlaceInOpenCv(line) || IsHarmless(line)) continue;
    return core::PrintableLine(WithoutPrefix(line), kMostBytes);
  }
  return {};
}

}  // namespace elbowroom::recon
