// An SVG as pixels.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace elbowroom::sessions {

// Pixels of a picture: RGB, 8 bits each, row by row from the top.
struct PixelsToPaint {
  int width_px = 0;
  int height_px = 0;
  std::span<std::uint8_t> rgb;
};

// Paints an SVG over a picture, at its own size, a px of it a pixel; `left_px` is the place of its left edge.
// An integer position in it is the middle of a pixel. What reaches out of the picture is cut off. Throws:
// Error{kFile} if the printer can't be loaded; PreconditionError if it is no SVG. Thread: any.
void PaintSvg(const std::string& svg, double left_px, const PixelsToPaint& pixels);

}  // namespace elbowroom::sessions
