// Pixels that are background whatever they show: a window, a monitor.
#pragma once

#include <opencv2/core/mat.hpp>

#include "core/bit_mask.h"
#include "core/soft_mask.h"

namespace elbowroom::recon {

[[nodiscard]] inline bool IsEmpty(const core::BitMask& mask) { return mask.width_px() == 0; }

// Makes the mask's pixels background where `ignore` has one. An empty `ignore` changes nothing.
void ClearPixels(const core::BitMask& ignore, core::BitMask* mask);

// The same of a mask with levels. A pixel on the boundary that was on it before keeps its level, unless it is
// ignored; where the boundary is new, it is halfway between the pixels.
[[nodiscard]] core::SoftMask WithoutPixels(const core::SoftMask& soft, const core::BitMask& ignore);

// Sets all channels (CV_32FC3) where `ignore` has a pixel.
void SetPixels(const core::BitMask& ignore, float level, cv::Mat* levels_bgr);

}  // namespace elbowroom::recon
