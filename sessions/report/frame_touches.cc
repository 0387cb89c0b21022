#include "sessions/report/frame_touches.h"

#include <algorithm>

#include "core/error.h"
#include "sessions/report/report_data.h"

namespace elbowroom::sessions {

std::size_t FramePlaces::Of(core::FrameIndex frame) {
  while (next_ < frames_.size() && frames_[next_].frame < frame) ++next_;
  core::Require(next_ < frames_.size() && frames_[next_].frame == frame, "rows come in order of frames");
  return next_;
}

FrameTouches::FrameTouches(const std::vector<FrameSummary>& frames, const core::Layout& layout)
    : places_(frames),
      bounding_(layout.parts.size()),
      is_touched_(frames.size(), false),
      depth_mm_(layout.spacings.size(), std::vector<float>(frames.size(), -1.0F)) {
  for (core::PartIndex part = 0; part < layout.parts.size(); ++part)
    for (core::SpacingIndex spacing = 0; spacing < layout.spacings.size(); ++spacing)
      if (IsBoundedBy(layout, part, spacing)) bounding_[part].push_back(spacing);
}

std::size_t FrameTouches::Add(core::FrameIndex frame, core::PartIndex part, double depth_mm) {
  const std::size_t place = places_.Of(frame);
  is_touched_[place] = true;
  for (const core::SpacingIndex spacing : bounding_[part]) {
    float& deepest = depth_mm_[spacing][place];
    deepest = std::max(deepest, static_cast<float>(depth_mm));
  }
  return place;
}

std::optional<double> FrameTouches::DepthAt(std::size_t place, core::SpacingIndex spacing) const {
  const float depth_mm = depth_mm_[spacing][place];
  return depth_mm < 0.0F ? std::nullopt : std::optional(static_cast<double>(depth_mm));
}

}  // namespace elbowroom::sessions
