#include "recon/capture/picture_pool.h"

#include <algorithm>

namespace elbowroom::recon {

PicturePool::PicturePool(cv::Size size_px) : size_px_(size_px) {
  for (int i = 0; i < kKept; ++i) kept_.emplace_back(size_px_, CV_8UC3, cv::Scalar::all(0));
}

// A count of 1 is the pool's own. Once it is 1, nobody can raise it but this thread.
cv::Mat PicturePool::Take() {
  const auto is_alone = [](const cv::Mat& picture) {
    return CV_XADD(&picture.u->refcount, 0) == 1;  // an atomic read
  };
  const auto found = std::ranges::find_if(kept_, is_alone);
  return found != kept_.end() ? *found : cv::Mat(size_px_, CV_8UC3);
}

}  // namespace elbowroom::recon
