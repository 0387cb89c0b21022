#include "recon/frame_segmenter.h"

#include <tbb/parallel_for.h>

#include "core/error.h"

namespace elbowroom::recon {

FrameSegmenter::FrameSegmenter(const std::vector<BackgroundReference>& backgrounds,
                               const SegmentationOptions& options) {
  options.Validate();
  for (const BackgroundReference& background : backgrounds) {
    segmenters_.emplace_back();
    if (!background.mean_bgr.empty()) segmenters_.back().emplace(background, options);
  }
}

std::vector<core::BitMask> FrameSegmenter::Segment(const FrameSet& frames) const {
  core::Require(frames.cameras.size() == segmenters_.size(), "one frame a camera");
  std::vector<core::BitMask> masks(frames.cameras.size());
  tbb::parallel_for(std::size_t{0}, masks.size(), [&](std::size_t i) {
    const CameraFrame& camera = frames.cameras[i];
    core::Require(camera.ready_mask || segmenters_[i], "a picture to segment has a background");
    masks[i] = camera.ready_mask ? *camera.ready_mask : segmenters_[i]->Segment(camera.image_bgr);
  });
  return masks;
}

}  // namespace elbowroom::recon
