// In which frames a tool was in use.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/session.h"

namespace elbowroom::control {

// From the frame from which it was marked in use to the one before that from which it was put away, or to the
// end.
class ToolSpans {
 public:
  // `events`: by frame, then as they came.
  ToolSpans(const std::string& tool, std::span<const core::SessionEvent> events);

  [[nodiscard]] bool Holds(core::FrameIndex frame) const;

 private:
  struct Span {
    core::FrameIndex first = 0;
    core::FrameIndex end = 0;  // not included
  };
  std::vector<Span> spans_;
};

}  // namespace elbowroom::control
