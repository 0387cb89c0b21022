// A frame set's silhouettes: ready masks as they are, pictures segmented.
#pragma once

#include <optional>
#include <vector>

#include "core/bit_mask.h"
#include "recon/frame_set.h"
#include "recon/segmentation.h"

namespace elbowroom::recon {

// One segmenter a camera that has a background. Immutable. Thread: any.
class FrameSegmenter {
 public:
  // Throws: core::Error{kRange} as SegmentationOptions::Validate().
  FrameSegmenter(const std::vector<BackgroundReference>& backgrounds, const SegmentationOptions& options);

  // One mask a camera, in parallel. Throws: PreconditionError for a picture whose camera has no background.
  [[nodiscard]] std::vector<core::BitMask> Segment(const FrameSet& frames) const;

 private:
  std::vector<std::optional<Segmenter>> segmenters_;
};

}  // namespace elbowroom::recon
