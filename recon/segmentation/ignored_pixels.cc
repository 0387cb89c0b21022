#include "recon/segmentation/ignored_pixels.h"

#include <bit>
#include <cstdint>
#include <opencv2/core.hpp>

namespace elbowroom::recon {

void ClearPixels(const core::BitMask& ignore, core::BitMask* mask) {
  if (IsEmpty(ignore)) return;
  for (std::size_t i = 0; i < ignore.words().size(); ++i) mask->words()[i] &= ~ignore.words()[i];
}

core::SoftMask WithoutPixels(const core::SoftMask& soft, const core::BitMask& ignore) {
  constexpr std::uint8_t kHalfwayInside = 191, kHalfwayOutside = 64;
  core::SoftMask left{soft.mask, {}};
  ClearPixels(ignore, &left.mask);
  if (soft.levels.empty()) return left;
  const core::BitMask before = core::BoundaryPixels(soft.mask), after = core::BoundaryPixels(left.mask);
  auto level = soft.levels.begin();
  for (std::size_t i = 0; i < before.words().size(); ++i) {
    for (std::uint64_t bits = before.words()[i] | after.words()[i]; bits != 0; bits &= bits - 1) {
      const std::uint64_t bit = bits & (~bits + 1);
      const bool was_boundary = (before.words()[i] & bit) != 0;
      const std::uint8_t known = was_boundary ? *level++ : std::uint8_t{0};
      if ((after.words()[i] & bit) == 0) continue;
      const bool is_object = (left.mask.words()[i] & bit) != 0;
      const bool was_object = (soft.mask.words()[i] & bit) != 0;
      const std::uint8_t otherwise = is_object ? kHalfwayInside : kHalfwayOutside;
      left.levels.push_back(was_boundary && is_object == was_object ? known : otherwise);
    }
  }
  return left;
}

void SetPixels(const core::BitMask& ignore, float level, cv::Mat* levels_bgr) {
  for (int y = 0; y < ignore.height_px(); ++y)
    for (int x = 0; x < ignore.width_px(); ++x)
      if (ignore.At(x, y)) levels_bgr->at<cv::Vec3f>(y, x) = cv::Vec3f::all(level);
}

}  // namespace elbowroom::recon
