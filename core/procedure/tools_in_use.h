// Which tools are marked in use, as the events of a trial say it one after the other.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "core/ids.h"
#include "core/session.h"

namespace elbowroom::core {

// A tool that is marked twice is in use once.
class ToolsInUse {
 public:
  void Take(const ToolMarked& mark) {
    const auto at = std::ranges::lower_bound(names_, mark.tool);
    const bool is_in_use = at != names_.end() && *at == mark.tool;
    if (mark.in_use && !is_in_use) names_.insert(at, mark.tool);
    if (!mark.in_use && is_in_use) names_.erase(at);
  }
  // Events of other kinds change nothing.
  void Take(const SessionEvent& event) {
    if (const auto* mark = std::get_if<ToolMarked>(&event.what)) Take(*mark);
  }

  [[nodiscard]] const std::vector<std::string>& names() const { return names_; }  // ascending

 private:
  std::vector<std::string> names_;
};

// The tools in use in each frame of a recording: from the frame with which one was marked, or to the end.
class ToolsOfFrames {
 public:
  // `events`: by frame, then as they came.
  explicit ToolsOfFrames(std::vector<SessionEvent> events) : events_(std::move(events)) {}

  // Ascending; valid until the next call. Frames must not decrease from call to call.
  [[nodiscard]] const std::vector<std::string>& At(FrameIndex frame) {
    for (; next_ < events_.size() && events_[next_].frame <= frame; ++next_) now_.Take(events_[next_]);
    return now_.names();
  }

 private:
  std::vector<SessionEvent> events_;
  std::size_t next_ = 0;
  ToolsInUse now_;
};

}  // namespace elbowroom::core
