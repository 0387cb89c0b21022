#include "app/control/keep_out/tool_spans.h"

#include <algorithm>
#include <limits>
#include <variant>

namespace elbowroom::control {

ToolSpans::ToolSpans(const std::string& tool, std::span<const core::SessionEvent> events) {
  constexpr core::FrameIndex kNoEnd = std::numeric_limits<core::FrameIndex>::max();
  for (const core::SessionEvent& event : events) {
    const auto* mark = std::get_if<core::ToolMarked>(&event.what);
    if (mark == nullptr || mark->tool != tool) continue;
    const bool is_in_use = !spans_.empty() && spans_.back().end == kNoEnd;
    if (mark->in_use && !is_in_use) spans_.push_back({event.frame, kNoEnd});
    if (!mark->in_use && is_in_use) spans_.back().end = event.frame;
  }
}

bool ToolSpans::Holds(core::FrameIndex frame) const {
  return std::ranges::any_of(spans_,
                             [&](const Span& span) { return span.first <= frame && frame < span.end; });
}

}  // namespace elbowroom::control
