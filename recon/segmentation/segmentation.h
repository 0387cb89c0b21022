// Which pixels of a camera image are object: image subtraction with thresholds, against the empty scene.
#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <optional>

#include "core/bit_mask.h"
#include "core/soft_mask.h"
#include "recon/footage/frame_set.h"
#include "recon/segmentation/exposure_estimator.h"
#include "recon/segmentation/followed_ranges.h"
#include "recon/segmentation/level_ranges.h"
#include "recon/segmentation/segmentation_options.h"

namespace elbowroom::recon {

struct SegmentationStats {
  std::int64_t pixels = 0;          // of the pictures segmented
  std::int64_t skipped_pixels = 0;  // of those: not looked at, as no region of min_blob_px can be there
  std::int64_t second_looks =
      0;  // pictures looked at again, for smaller blobs; their pixels don't count twice

  // Adds the counts of other pictures.
  SegmentationStats& operator+=(const SegmentationStats& other);
};

// The fewest pixels of a blob that is kept.
enum class BlobLimit {
  kUsual,  // SegmentationOptions::min_blob_px
  kSmall,  // kSmallestBlobPx, where other cameras say that something is there
};
inline constexpr int kSmallestBlobPx = 8;  // a cable of 6 mm that points at a camera 1.2 m away has 9

// One camera's background with its thresholds worked out. Immutable.
//
// Object where |I - mean| > max(k_sigma * sigma, floor_levels) + edge_slack_px * |gradient of mean| in any
// channel: the paper's image subtraction with thresholds, in units of each pixel's noise. Shadows are left
// out: pixels darker than the background in the same colour. Then small regions are removed and small holes
// filled. A picture without any difference gives an empty mask. The same result for any number of threads.
class Segmenter {
 public:
  // `options.cameras` isn't looked at. Pixels of `ignore` (none: it has no size) are background in every
  // picture. Throws: Error{kRange} as Validate(); PreconditionError for an empty background, or an `ignore`
  // of another size.
  Segmenter(const BackgroundReference& background, const SegmentationOptions& options,
            core::BitMask ignore = {});

  // The pixels detected as above; `stats` receives the counts. Throws: PreconditionError unless `image_bgr`
  // is CV_8UC3 of the background's size.
  [[nodiscard]] core::BitMask Segment(const cv::Mat& image_bgr, SegmentationStats* stats = nullptr,
                                      BlobLimit limit = BlobLimit::kUsual) const;

  // The same with its boundary located between pixels, as LocateBoundary. Throws: likewise.
  [[nodiscard]] core::SoftMask SegmentSoft(const cv::Mat& image_bgr, SegmentationStats* stats = nullptr,
                                           BlobLimit limit = BlobLimit::kUsual) const;

 private:
  // The change that a picture is compared under; nothing for kThreshold. Throws: as Segment().
  [[nodiscard]] std::optional<FixedExposure> ExposureOf(const cv::Mat& image_bgr) const;
  [[nodiscard]] core::BitMask Detect(const cv::Mat& image_bgr, const std::optional<FixedExposure>& exposure,
                                     BlobLimit limit, SegmentationStats* stats) const;

  SegmentationOptions options_;
  core::BitMask ignore_;  // without a size if no pixel is ignored
  cv::Size size_;
  cv::Mat packed_mean_;
  LevelRanges ranges_;  // for kThreshold; the next two are for kAdaptive
  FollowedRanges followed_ranges_;
  ExposureEstimator exposure_estimator_;
};

}  // namespace elbowroom::recon
