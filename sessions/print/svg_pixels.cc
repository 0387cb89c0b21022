#include "sessions/print/svg_pixels.h"

#include "core/error.h"
#include "sessions/print/printer.h"

namespace elbowroom::sessions {

void PaintSvg(const std::string& svg, double left_px, const PixelsToPaint& pixels) {
  core::Require(pixels.width_px > 0 && pixels.height_px > 0 &&
                    pixels.rgb.size() == 3 * static_cast<std::size_t>(pixels.width_px) *
                                             static_cast<std::size_t>(pixels.height_px),
                "a picture has three values a pixel");
  LoadedPrinter().paint(svg, left_px, pixels);
}

}  // namespace elbowroom::sessions
