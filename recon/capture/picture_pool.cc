#include "recon/capture/picture_pool.h"

#include <algorithm>
#include <cstddef>

namespace elbowroom::recon {
namespace {

// More pictures than a consumer in pace holds; beyond that, memory comes and goes.
constexpr std::size_t kMostKept = 16;

}  // namespace

// A count of 1 is the pool's own. Once it is 1, nobody can raise it but this thread.
cv::Mat PicturePool::Take() {
  const auto is_alone = [](const cv::Mat& picture) {
    return CV_XADD(&picture.u->refcount, 0) == 1;  // an atomic read
  };
  const auto found = std::ranges::find_if(kept_, is_alone);
  if (found != kept_.end()) return *found;
  cv::Mat picture(size_px_, CV_8UC3);
  if (kept_.size() < kMostKept) kept_.push_back(picture);
  return picture;
}

}  // namespace elbowroom::recon
