// How deep parts were touched, frame by frame, for each spacing.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/ids.h"
#include "core/layout.h"
#include "sessions/session_reader.h"

namespace elbowroom::sessions {

// Where a frame is among all; asked in order of the frames, again and again.
class FramePlaces {
 public:
  explicit FramePlaces(const std::vector<FrameSummary>& frames) : frames_(frames) {}

  // Throws: PreconditionError for a frame that isn't one, or is before the one asked last.
  [[nodiscard]] std::size_t Of(core::FrameIndex frame);

 private:
  const std::vector<FrameSummary>& frames_;
  std::size_t next_ = 0;
};

class FrameTouches {
 public:
  // Both must outlive this.
  FrameTouches(const std::vector<FrameSummary>& frames, const core::Layout& layout);

  // In order of the frames. Returns the frame's place. Throws: as FramePlaces.
  std::size_t Add(core::FrameIndex frame, core::PartIndex part, double depth_mm);

  [[nodiscard]] bool IsTouched(std::size_t place) const { return is_touched_[place]; }
  // Of the parts that the spacing bounds; nothing: none was touched.
  [[nodiscard]] std::optional<double> DepthAt(std::size_t place, core::SpacingIndex spacing) const;

 private:
  FramePlaces places_;
  std::vector<std::vector<core::SpacingIndex>> bounding_;  // of each part
  std::vector<bool> is_touched_;
  std::vector<std::vector<float>> depth_mm_;  // by spacing, by place; negative: no touch
};

}  // namespace elbowroom::sessions
