// Drawings on pixels.
#pragma once

#include <string>

#include "sessions/print/svg_pixels.h"

namespace elbowroom::sessions {

// As PaintSvg (svg_pixels.h).
void PaintOnPixels(const std::string& svg, double left_px, const PixelsToPaint& pixels);

}  // namespace elbowroom::sessions
