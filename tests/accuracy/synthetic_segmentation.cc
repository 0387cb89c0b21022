#include "tests/accuracy/synthetic_segmentation.h"

#include "core/error.h"
#include "recon/footage/background.h"
#include "recon/synthetic/sensor_noise.h"

namespace elbowroom::accuracy {

SightSegmenter::SightSegmenter(const core::Rig& rig, double noise_levels, std::uint64_t seed)
    : noise_levels_(noise_levels), seed_(seed) {
  for (std::size_t i = 0; i < rig.cameras.size(); ++i) {
    views_.emplace_back(rig.cameras[i], seed);
    recon::BackgroundAccumulator background;
    for (int frame = 1; frame <= kBackgroundFrames; ++frame) background.Add(Capture(i, {}, -frame));
    segmenters_.emplace_back(background.Reference(), recon::SegmentationOptions{});
  }
}

cv::Mat SightSegmenter::Capture(std::size_t camera, std::span<const recon::Solid> solids,
                                std::int64_t frame) const {
  return views_[camera].Render(solids, {.noise_sigma_levels = noise_levels_,
                                        .noise_seed = recon::StreamSeed(seed_, frame, camera, 0),
                                        .samples_per_pixel_side = kRaysPerPixelSide});
}

std::vector<core::SoftMask> SightSegmenter::Segment(std::span<const oracles::Sight> sights,
                                                    std::int64_t frame) const {
  core::Require(sights.size() == views_.size(), "one sight a camera");
  core::Require(frame >= 0, "frames before 0 are the background's");
  std::vector<core::SoftMask> masks;
  for (std::size_t i = 0; i < sights.size(); ++i)
    masks.push_back(segmenters_[i].SegmentSoft(Capture(i, sights[i].solids, frame)));
  return masks;
}

}  // namespace elbowroom::accuracy
