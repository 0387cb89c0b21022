#include "core/tools_in_use.h"

#include <algorithm>
#include <variant>

namespace elbowroom::core {

void ToolsInUse::Take(const ToolMarked& mark) {
  const auto at = std::ranges::lower_bound(names_, mark.tool);
  const bool is_in_use = at != names_.end() && *at == mark.tool;
  if (mark.in_use && !is_in_use) names_.insert(at, mark.tool);
  if (!mark.in_use && is_in_use) names_.erase(at);
}

void ToolsInUse::Take(const SessionEvent& event) {
  if (const auto* mark = std::get_if<ToolMarked>(&event.what)) Take(*mark);
}

const std::vector<std::string>& ToolsOfFrames::At(FrameIndex frame) {
  for (; next_ < events_.size() && events_[next_].frame <= frame; ++next_) now_.Take(events_[next_]);
  return now_.names();
}

}  // namespace elbowroom::core
