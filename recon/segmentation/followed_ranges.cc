#include "recon/segmentation/followed_ranges.h"

#include <algorithm>
#include <cmath>

namespace elbowroom::recon {
namespace {

constexpr int kLevelsOfWord = 192;  // of 64 pixels

std::int16_t InSixtyFourths(double level) {
  constexpr double kOne = 1 << FollowedRanges::kLevelBits;
  constexpr double kLeastLevel = -256.0;
  return static_cast<std::int16_t>(
      std::lround(std::clamp(level * kOne, kLeastLevel * kOne, double{FollowedRanges::kNoHighest})));
}

}  // namespace

FollowedRanges::FollowedRanges(const cv::Mat& mean_bgr, const cv::Mat& threshold_bgr)
    : width_px_(mean_bgr.cols), height_px_(mean_bgr.rows) {
  const int groups = (height_px_ + kSharingRows - 1) / kSharingRows, words = (width_px_ + 63) / 64;
  levels_.create(groups, words * kSharingRows * 2 * kLevelsOfWord, CV_16S);
  mean_ = cv::Mat::zeros(groups, words * kSharingRows * kLevelsOfWord, CV_32F);
  for (int y = 0; y < groups * kSharingRows; ++y) {
    const int group = y / kSharingRows, row = y % kSharingRows;
    for (int word = 0; word < words; ++word) {
      const int number = word * kSharingRows + row, first = word * kLevelsOfWord;
      auto* lowest = levels_.ptr<std::int16_t>(group) + number * 2 * kLevelsOfWord;
      std::int16_t* highest = lowest + kLevelsOfWord;
      std::fill(lowest, highest, kNoLowest);
      std::fill(highest, highest + kLevelsOfWord, kNoHighest);
      if (y >= height_px_) continue;
      const auto* mean = mean_bgr.ptr<float>(y) + first;
      const auto* threshold = threshold_bgr.ptr<float>(y) + first;
      const int count = std::min(kLevelsOfWord, width_px_ * 3 - first);
      std::copy_n(mean, count, mean_.ptr<float>(group) + number * kLevelsOfWord);
      for (int i = 0; i < count; ++i) {
        lowest[i] = InSixtyFourths(static_cast<double>(mean[i]) - threshold[i]);
        highest[i] = InSixtyFourths(static_cast<double>(mean[i]) + threshold[i]);
      }
    }
  }
  Share();
}

void FollowedRanges::Share() {
  const int words = (width_px_ + 63) / 64;
  shared_.create(levels_.rows, words * 2 * kLevelsOfWord, CV_16S);
  for (int group = 0; group < levels_.rows; ++group) {
    for (int word = 0; word < words; ++word) {
      const auto* own = levels_.ptr<std::int16_t>(group) + word * kSharingRows * 2 * kLevelsOfWord;
      auto* lowest = shared_.ptr<std::int16_t>(group) + word * 2 * kLevelsOfWord;
      std::int16_t* highest = lowest + kLevelsOfWord;
      std::copy_n(own, 2 * kLevelsOfWord, lowest);
      for (int row = 1; row < kSharingRows; ++row) {
        own += static_cast<std::ptrdiff_t>(2) * kLevelsOfWord;
        for (int i = 0; i < kLevelsOfWord; ++i) {
          lowest[i] = std::max(lowest[i], own[i]);
          highest[i] = std::min(highest[i], own[kLevelsOfWord + i]);
        }
      }
    }
  }
}

}  // namespace elbowroom::recon
