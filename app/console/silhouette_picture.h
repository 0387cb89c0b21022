// A silhouette as a small grey picture.
#pragma once

#include <QImage>

#include "core/bit_mask.h"

namespace elbowroom::console {

// At most `max_width_px` wide where the mask is up to 64 times that: each pixel is the mean of a square block
// of the mask, in the console's two silhouette colours. Blocks that the mask doesn't fill are left out at the
// right and lower edge; a mask of no size gives a null picture. max_width_px > 0.
[[nodiscard]] QImage SilhouettePicture(const core::BitMask& mask, int max_width_px);

}  // namespace elbowroom::console
