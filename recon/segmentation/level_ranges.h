// The empty scene as the levels that its pixels may have, laid out for the inner loop of segmentation.
#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>

namespace elbowroom::recon {

// For every pixel and channel the lowest and the highest level that still counts as background, laid out for
// the kernel. The kernel's time goes into reading these ranges, so there is a second, smaller table: the
// range that four pixels below one another have in common. A picture's level inside the common range is
// inside the pixel's own, so only pixels outside of it need their own range. Most are inside, and two thirds
// of the reading is saved. The result is the same.
class LevelRanges {
 public:
  static constexpr int kSharingRows = 4;  // rows 4 i to 4 i + 3

  LevelRanges() = default;

  // The whole numbers within `threshold_bgr` of `mean_bgr` (both CV_32FC3). A picture's levels I are whole
  // numbers, so lowest <= I <= highest is exactly the same as |I - mean| <= threshold.
  LevelRanges(const cv::Mat& mean_bgr, const cv::Mat& threshold_bgr);

  [[nodiscard]] int width_px() const { return width_px_; }
  [[nodiscard]] int height_px() const { return height_px_; }

  // CV_8U, a row for each kSharingRows rows of pixels. For each 64 pixels across, and for each of these rows
  // in turn: 192 lowest, then 192 highest levels; 64-byte aligned. So a cell's levels follow one another in
  // memory, on one page or two. Pixels past the row's end may have any level.
  [[nodiscard]] const cv::Mat& levels() const { return levels_; }

  // CV_32F, in the same order: 192 means for each 64 pixels of a row; zero past the row's end.
  [[nodiscard]] const cv::Mat& mean() const { return mean_; }

  // CV_8U, a row for each kSharingRows rows of pixels. For each pixel and channel across: the lowest of the
  // shared_width() + 1 levels that are background in all these rows.
  [[nodiscard]] const cv::Mat& shared_lowest() const { return shared_lowest_; }

  // CV_16S, with the same rows. One number for each 64 pixels across, so that one comparison serves them all.
  // kNoneShared: the rows of one of these pixels have no level in common.
  [[nodiscard]] const cv::Mat& shared_width() const { return shared_width_; }
  static constexpr std::int16_t kNoneShared = -1;

 private:
  void Share();

  int width_px_ = 0;
  int height_px_ = 0;
  cv::Mat levels_, shared_lowest_;  // CV_8U
  cv::Mat mean_;                    // CV_32F
  cv::Mat shared_width_;            // CV_16S
};

}  // namespace elbowroom::recon
