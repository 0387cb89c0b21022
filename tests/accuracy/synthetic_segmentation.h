// Pictures of solids with sensor noise, segmented as the program does it.
#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <span>
#include <vector>

#include "core/rig.h"
#include "core/soft_mask.h"
#include "recon/segmentation/segmentation.h"
#include "recon/synthetic/camera_view.h"
#include "tests/oracles/analytic_hull.h"

namespace elbowroom::accuracy {

inline constexpr int kBackgroundFrames = 30;
inline constexpr int kRaysPerPixelSide = 8;

// The cameras of a rig (the true one), their backgrounds of kBackgroundFrames frames measured: renders what
// each saw, each pixel on an edge the mixture of kRaysPerPixelSide x kRaysPerPixelSide rays, as a sensor
// mixes what falls on it, with Gaussian noise on every pixel and channel; and segments it with the default
// options, boundaries located between pixels. Immutable. Thread: any.
class SightSegmenter {
 public:
  SightSegmenter(const core::Rig& rig, double noise_levels, std::uint64_t seed);

  // One sight a camera. Frames from 0 on have noise of their own each.
  [[nodiscard]] std::vector<core::SoftMask> Segment(std::span<const oracles::Sight> sights,
                                                    std::int64_t frame = 0) const;

 private:
  [[nodiscard]] cv::Mat Capture(std::size_t camera, std::span<const recon::Solid> solids,
                                std::int64_t frame) const;

  double noise_levels_ = 0.0;
  std::uint64_t seed_ = 0;
  std::vector<recon::CameraView> views_;
  std::vector<recon::Segmenter> segmenters_;
};

}  // namespace elbowroom::accuracy
