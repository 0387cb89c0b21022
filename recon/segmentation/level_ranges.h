// The empty scene as the levels that its pixels may have, laid out for the inner loop of segmentation.
#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>

namespace elbowroom::recon {

// The levels that every pixel and channel may have and still be background, laid out for the kernel. Most
// pixels are also within the levels that they share with those above and below: reading these first leaves
// out two thirds of what reading is about, and the result is the same.
class LevelRanges {
 public:
  static constexpr int kSharingRows = 4;  // rows 4 i to 4 i + 3

  LevelRanges() = default;

  // The whole levels within `threshold_bgr` of `mean_bgr` (both CV_32FC3): a picture's levels are whole, so
  // asking lowest <= I <= highest is the same as asking |I - mean| <= threshold. Exact.
  LevelRanges(const cv::Mat& mean_bgr, const cv::Mat& threshold_bgr);

  [[nodiscard]] int width_px() const { return width_px_; }
  [[nodiscard]] int height_px() const { return height_px_; }

  // For each 64 pixels of a row their 192 lowest, then their 192 highest levels; 64-byte aligned. Pixels past
  // the row's end may have any level.
  [[nodiscard]] const std::uint8_t* row(int y) const { return levels_.ptr<std::uint8_t>(y); }

  // The lowest levels of pixels that stand below one another in the rows that y shares with. A level that is
  // no more than shared_width() above it is within the ranges of all of them.
  [[nodiscard]] const std::uint8_t* shared_lowest(int y) const {
    return shared_lowest_.ptr<std::uint8_t>(y / kSharingRows);
  }

  // For each 64 pixels of the rows that y shares with; kNoneShared: one of them has no level in common.
  [[nodiscard]] const std::int16_t* shared_width(int y) const {
    return shared_width_.ptr<std::int16_t>(y / kSharingRows);
  }
  static constexpr std::int16_t kNoneShared = -1;

 private:
  void Share();

  int width_px_ = 0;
  int height_px_ = 0;
  cv::Mat levels_, shared_lowest_;  // CV_8U
  cv::Mat shared_width_;            // CV_16S
};

}  // namespace elbowroom::recon
