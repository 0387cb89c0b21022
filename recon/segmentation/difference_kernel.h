// The inner loop of segmentation: which pixels differ from the empty scene and aren't its shade.
#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>

#include "core/bit_mask.h"
#include "recon/segmentation/exposure.h"
#include "recon/segmentation/followed_ranges.h"
#include "recon/segmentation/level_ranges.h"

namespace elbowroom::recon {

// Shade is the background with less light. B is the background's mean, and g = I.B / B.B is the share of its
// light that is left. A pixel is shade if darkest <= g < 1 and if the rest I - g B, a change of colour, is
// shorter than chroma |g B| or than noise_levels.
struct ShadeRule {
  float darkest = 0.0F;
  float chroma = 0.0F;
  float noise_levels = 0.0F;
};

// Pixels with a channel outside its range; those that are shade are left out if there is a rule. 8-connected
// regions of fewer than `least_px` pixels may be missing, as a whole or in part: if `least_px` is above 132,
// not all pixels have to be looked at, and `skipped_px` receives how many weren't. `image_bgr` (CV_8UC3, any
// row stride) is of the ranges' size. AVX-512, AVX2, SSE4, SSSE3 and plain code,
// chosen at run time, give the same bits (tests/recon/segmentation/difference_kernel_test.cc).
[[nodiscard]] core::BitMask DifferingPixels(const LevelRanges& ranges, const cv::Mat& image_bgr,
                                            int least_px = 0, std::int64_t* skipped_px = nullptr);
[[nodiscard]] core::BitMask DifferingPixels(const LevelRanges& ranges, const cv::Mat& image_bgr,
                                            const ShadeRule& shade, int least_px = 0,
                                            std::int64_t* skipped_px = nullptr);

// The same against ranges and means that a change of exposure is applied to first; `shade` may be null.
[[nodiscard]] core::BitMask DifferingPixels(const FollowedRanges& ranges, const FixedExposure& exposure,
                                            const cv::Mat& image_bgr, const ShadeRule* shade,
                                            int least_px = 0, std::int64_t* skipped_px = nullptr);

}  // namespace elbowroom::recon
