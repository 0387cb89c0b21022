// The boundary located pixel by pixel, as docs/segmentation.md words it: slow and without vectors.
#pragma once

#include <opencv2/core/mat.hpp>

#include "core/bit_mask.h"
#include "core/soft_mask.h"

namespace elbowroom::recon {

// What LocateBoundary (recon/segmentation/boundary.h) must give, bit by bit.
[[nodiscard]] core::SoftMask LocateBoundarySlowly(const core::BitMask& detected, const cv::Mat& image_bgr,
                                                  const cv::Mat& packed_mean, double least_contrast_levels);

}  // namespace elbowroom::recon
