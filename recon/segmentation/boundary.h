// Where between two pixels an object ends.
#pragma once

#include <opencv2/core/mat.hpp>

#include "core/bit_mask.h"
#include "core/soft_mask.h"
#include "recon/segmentation/exposure.h"

namespace elbowroom::recon {

// Moves the boundary of `detected` to where half of a pixel is object (by two pixels at most), and gives each
// pixel along it a level: how far inside or outside of the boundary it is. A pixel's share of object is alpha
// = (I - gB).(O - gB) / |O - gB|^2; the object's colour O is taken a few pixels inwards, the background's
// light g a few pixels outwards. The boundary is placed by the sum of alpha across it, which doesn't depend
// on how the lens blurs (docs/segmentation.md, tests/recon/segmentation/boundary_test.cc). Where object and
// background differ by less than `least_contrast_levels` the detected boundary stays, halfway between the
// pixels. Thin objects stay at least a pixel wide. `packed_mean`: the background, as PackedMean
// (recon/segmentation/coverage.h), to which `exposure` is applied first unless it is null. Throws:
// PreconditionError unless CV_8UC3 and CV_32SC1 of the mask's size.
[[nodiscard]] core::SoftMask LocateBoundary(const core::BitMask& detected, const cv::Mat& image_bgr,
                                            const cv::Mat& packed_mean, double least_contrast_levels,
                                            const FixedExposure* exposure = nullptr);

}  // namespace elbowroom::recon
