// The empty scene as the levels that its pixels may have, kept so that a change of exposure can be applied.
#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>

namespace elbowroom::recon {

// As LevelRanges, but with fractions of a level, and with levels below 0 and above 255. Under a gain g and an
// offset o the range [lowest, highest] of a pixel becomes [g lowest + o, g highest + o]. This maps ranges in
// order, so the range that four pixels below one another share stays shared, and what is looked at first
// stays enough (docs/segmentation.md).
class FollowedRanges {
 public:
  static constexpr int kSharingRows = 4;  // rows 4 i to 4 i + 3
  static constexpr int kLevelBits = 6;    // levels are in 1 / 64
  // Past a row's end, and where a pixel never counts as object: about -512 and 512 levels.
  static constexpr std::int16_t kNoLowest = -32768, kNoHighest = 32767;

  FollowedRanges() = default;

  // `threshold_bgr` (as `mean_bgr`: CV_32FC3) around the mean, each end rounded to the nearest 1/64 level and
  // cut to -256..511.98 levels.
  FollowedRanges(const cv::Mat& mean_bgr, const cv::Mat& threshold_bgr);

  [[nodiscard]] int width_px() const { return width_px_; }
  [[nodiscard]] int height_px() const { return height_px_; }

  // CV_16S, a row for each kSharingRows rows of pixels. For each 64 pixels across, and for each of these rows
  // in turn: 192 lowest, then 192 highest; 64-byte aligned.
  [[nodiscard]] const cv::Mat& levels() const { return levels_; }

  // CV_16S, with the same rows. For each 64 pixels across: 192 largest of the rows' lowest, then 192 smallest
  // of their highest.
  [[nodiscard]] const cv::Mat& shared() const { return shared_; }

  // CV_32F, in the order of levels(): 192 means for each 64 pixels of a row; zero past the row's end.
  [[nodiscard]] const cv::Mat& mean() const { return mean_; }

 private:
  void Share();

  int width_px_ = 0;
  int height_px_ = 0;
  cv::Mat levels_, shared_;  // CV_16S
  cv::Mat mean_;             // CV_32F
};

}  // namespace elbowroom::recon
