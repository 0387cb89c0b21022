// Memory for pictures, used again once nobody looks at them any more.
#pragma once

#include <opencv2/core/mat.hpp>
#include <vector>

namespace elbowroom::recon {

// All of its memory is taken at the beginning: kKept pictures. Thread: one; the pictures may be let go of on
// any thread.
class PicturePool {
 public:
  // As many as there are on their way at once: two that wait for their mates, LiveRig::kMostReady, the one
  // that is judged, and the last one. Beyond these, memory comes and goes.
  static constexpr int kKept = 8;

  explicit PicturePool(cv::Size size_px);

  // A CV_8UC3 picture that nobody else holds. Its pixels are of no meaning.
  [[nodiscard]] cv::Mat Take();

 private:
  cv::Size size_px_;
  std::vector<cv::Mat> kept_;
};

}  // namespace elbowroom::recon
