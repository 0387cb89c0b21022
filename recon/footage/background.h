// The empty scene as a camera sees it, measured from frames of it.
#pragma once

#include <opencv2/core/mat.hpp>

#include "recon/footage/frame_set.h"

namespace elbowroom::recon {

// Per-pixel, per-channel mean and sample standard deviation over frames of the empty scene. The sums are
// whole numbers, so the result is exact to the last rounding and does not depend on the order of the frames.
class BackgroundAccumulator {
 public:
  // More would overflow the sums; 44 minutes at 25 fps.
  static constexpr int kMostFrames = 66'000;

  // Throws: PreconditionError unless `image_bgr` is CV_8UC3, of the first frame's size, and one of at most
  // kMostFrames.
  void Add(const cv::Mat& image_bgr);

  [[nodiscard]] int frames() const { return frames_; }

  // Throws: PreconditionError without a frame.
  [[nodiscard]] BackgroundReference Reference() const;

 private:
  int frames_ = 0;
  cv::Mat sum_;          // 32-bit unsigned, stored as CV_32SC3
  cv::Mat sum_squares_;  // likewise
};

}  // namespace elbowroom::recon
