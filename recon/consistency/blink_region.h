// Where a blinking light is in a camera's pictures, and how bright it is in each.
#pragma once

#include <opencv2/core/mat.hpp>
#include <optional>
#include <span>
#include <vector>

namespace elbowroom::recon {

// The pixels that blink.
struct BlinkRegion {
  int width_px = 0, height_px = 0;  // of the pictures
  std::vector<int> pixels;          // y * width_px + x, ascending
  double row_px = 0.0;              // their mean row
  // None of the pixels reaches the highest level, so that the brightness is proportional to the light. Else a
  // partly lit picture looks brighter than it is.
  bool is_linear = true;
};

// The region whose levels go up and down most often and most strongly, 8-connected, in 8-bit pictures of one
// size with one or three channels. If enough of its pixels never reach level 250, as in the light's halo,
// those alone are kept. Some seconds of pictures are enough. Nothing: no pixel changes by 30 levels from one
// picture to the next in a tenth of them. Throws: PreconditionError for fewer than 20 pictures, or pictures
// of another kind.
[[nodiscard]] std::optional<BlinkRegion> FindBlinkingRegion(std::span<const cv::Mat> pictures);

// The sum of the grey levels of the region's pixels. Throws: PreconditionError for a picture of another size
// or kind.
[[nodiscard]] double BrightnessIn(const cv::Mat& picture, const BlinkRegion& region);

}  // namespace elbowroom::recon
