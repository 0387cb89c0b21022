#include "recon/segmentation/level_ranges.h"

#include <algorithm>

namespace elbowroom::recon {
namespace {

constexpr int kBytes = 192;  // of 64 pixels

// The number of a row's 64 pixels in the tables' row for their group.
int NumberInGroup(int y, int word) {
  return word * LevelRanges::kSharingRows + y % LevelRanges::kSharingRows;
}

}  // namespace

LevelRanges::LevelRanges(const cv::Mat& mean_bgr, const cv::Mat& threshold_bgr)
    : width_px_(mean_bgr.cols), height_px_(mean_bgr.rows) {
  const int groups = (height_px_ + kSharingRows - 1) / kSharingRows, words = (width_px_ + 63) / 64;
  levels_.create(groups, words * kSharingRows * 2 * kBytes, CV_8U);
  mean_ = cv::Mat::zeros(groups, words * kSharingRows * kBytes, CV_32F);
  for (int y = 0; y < height_px_; ++y) {
    const auto* mean = mean_bgr.ptr<float>(y);
    const auto* threshold = threshold_bgr.ptr<float>(y);
    for (int first = 0; first < width_px_ * 3; first += kBytes) {
      const int number = NumberInGroup(y, first / kBytes);
      auto* lowest = levels_.ptr<std::uint8_t>(y / kSharingRows) + number * 2 * kBytes;
      std::uint8_t* highest = lowest + kBytes;
      const int count = std::min(kBytes, width_px_ * 3 - first);
      std::copy_n(mean + first, count, mean_.ptr<float>(y / kSharingRows) + number * kBytes);
      for (int i = 0; i < count; ++i) {
        // Sums of two floats are exact in double. Rounded by hand: std::ceil and std::floor are calls on
        // plain x86-64.
        const double low =
            std::clamp(static_cast<double>(mean[first + i]) - threshold[first + i], 0.0, 255.0);
        const double high =
            std::clamp(static_cast<double>(mean[first + i]) + threshold[first + i], 0.0, 255.0);
        const int below_low = static_cast<int>(low);
        lowest[i] = static_cast<std::uint8_t>(below_low + (below_low < low ? 1 : 0));
        highest[i] = static_cast<std::uint8_t>(static_cast<int>(high));
      }
      std::fill(lowest + count, lowest + kBytes, std::uint8_t{0});
      std::fill(highest + count, highest + kBytes, std::uint8_t{255});
    }
  }
  Share();
}

void LevelRanges::Share() {
  const int groups = (height_px_ + kSharingRows - 1) / kSharingRows, words = (width_px_ + 63) / 64;
  shared_lowest_.create(groups, words * kBytes, CV_8U);
  shared_width_.create(groups, words, CV_16S);
  for (int group = 0; group < groups; ++group) {
    const int begin = group * kSharingRows, end = std::min(begin + kSharingRows, height_px_);
    for (int word = 0; word < words; ++word) {
      std::uint8_t lowest[kBytes], highest[kBytes];
      std::fill(lowest, lowest + kBytes, std::uint8_t{0});
      std::fill(highest, highest + kBytes, std::uint8_t{255});
      for (int y = begin; y < end; ++y) {
        const std::uint8_t* levels = levels_.ptr<std::uint8_t>(group) + NumberInGroup(y, word) * 2 * kBytes;
        for (int i = 0; i < kBytes; ++i) lowest[i] = std::max(lowest[i], levels[i]);
        for (int i = 0; i < kBytes; ++i) highest[i] = std::min(highest[i], levels[kBytes + i]);
      }
      int width = 255;
      for (int i = 0; i < kBytes; ++i) width = std::min(width, highest[i] - lowest[i]);
      shared_width_.at<std::int16_t>(group, word) =
          width < 0 ? kNoneShared : static_cast<std::int16_t>(width);
      // The shared range is placed in the middle of each range, where the background's levels are. Bytes past
      // the row's end are zero.
      auto* shared = shared_lowest_.ptr<std::uint8_t>(group) + word * kBytes;
      const int count = std::min(kBytes, width_px_ * 3 - word * kBytes);
      for (int i = 0; i < kBytes; ++i)
        shared[i] = i < count && width >= 0
                        ? static_cast<std::uint8_t>(lowest[i] + (highest[i] - lowest[i] - width) / 2)
                        : std::uint8_t{0};
    }
  }
}

}  // namespace elbowroom::recon
