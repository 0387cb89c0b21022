#include "app/cli/options/frame_range_option.h"

#include <charconv>
#include <string>
#include <system_error>

namespace elbowroom::cli {
namespace {

bool ParseFrameRange(const std::string& text, control::FrameRange* range) {
  const std::size_t colon = text.find(':');
  if (colon == std::string::npos) return false;
  const auto number = [&](std::size_t begin, std::size_t end, core::FrameIndex* value) {
    const char* last = text.data() + end;
    const auto [stop, error] = std::from_chars(text.data() + begin, last, *value);
    return error == std::errc() && stop == last && *value >= 0;
  };
  core::FrameIndex end = 0;
  if (colon > 0 && !number(0, colon, &range->first)) return false;
  if (colon + 1 == text.size()) return true;
  if (!number(colon + 1, text.size(), &end)) return false;
  range->end = end;
  return range->first < end;
}

}  // namespace

void AddFrameRangeOption(CLI::App& command, control::FrameRange* range) {
  command
      .add_option("--frames", "frames A to B, B not included; A: and :B leave one end open (default: all)")
      ->type_name("A:B")
      ->each([range](const std::string& text) {
        if (!ParseFrameRange(text, range))
          throw CLI::ValidationError("must be A:B, two frame numbers from 0 with A below B");
      });
}

}  // namespace elbowroom::cli
