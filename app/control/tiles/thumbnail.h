// A camera's picture, small, with the outline of its silhouette.
#pragma once

#include <array>
#include <cstdint>
#include <opencv2/core/mat.hpp>

#include "core/bit_mask.h"
#include "recon/images/image.h"

namespace elbowroom::control {

struct ThumbnailRoom {
  int width_px = 0;  // 0: none
  int height_px = 0;

  [[nodiscard]] bool is_empty() const { return width_px <= 0 || height_px <= 0; }
  [[nodiscard]] bool operator==(const ThumbnailRoom&) const = default;
};

// Red, green, blue. The outline is a bright line on the silhouette's side of its boundary and a dark one on
// the other, so that it is seen on any picture.
using ThumbnailColor = std::array<std::uint8_t, 3>;
inline constexpr ThumbnailColor kOutline = {0xff, 0xd2, 0x3f}, kOutlineShade = {0x14, 0x18, 0x1d};
// Without a picture the silhouette itself is shown, in these two colours.
inline constexpr ThumbnailColor kMaskObject = {0xb9, 0xc2, 0xcc}, kMaskBackground = {0x24, 0x2b, 0x33};

// The largest picture of the mask's proportions that the room holds, at most as large as the mask.
// `image_bgr` has the mask's size, or none: ready masks. An empty room, or a mask without a size, gives an
// empty image. Throws: PreconditionError for a picture of another size.
[[nodiscard]] recon::Image ThumbnailOf(const cv::Mat& image_bgr, const core::BitMask& mask,
                                       const ThumbnailRoom& room);

}  // namespace elbowroom::control
