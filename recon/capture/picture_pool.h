// Memory for pictures, used again once nobody looks at them any more.
#pragma once

#include <opencv2/core/mat.hpp>
#include <vector>

namespace elbowroom::recon {

// Thread: one; the pictures may be let go of on any thread.
class PicturePool {
 public:
  explicit PicturePool(cv::Size size_px) : size_px_(size_px) {}

  // A CV_8UC3 picture that nobody else holds. Its pixels are of no meaning.
  [[nodiscard]] cv::Mat Take();

 private:
  cv::Size size_px_;
  std::vector<cv::Mat> kept_;
};

}  // namespace elbowroom::recon
