#include "sessions/print/pixel_painter.h"

#include <memory>

#include "core/error.h"
#include "sessions/print/svg_drawing.h"

namespace elbowroom::sessions {
namespace {

// A row of cairo's pixels: 0xffrrggbb.
std::span<std::uint32_t> RowOf(cairo_surface_t* surface, int row, int width_px) {
  unsigned char* bytes = cairo_image_surface_get_data(surface) +
                         static_cast<std::ptrdiff_t>(row) * cairo_image_surface_get_stride(surface);
  return {reinterpret_cast<std::uint32_t*>(bytes), static_cast<std::size_t>(width_px)};
}

std::span<std::uint8_t> RowOf(const PixelsToPaint& pixels, int row) {
  const std::size_t size = 3 * static_cast<std::size_t>(pixels.width_px);
  return pixels.rgb.subspan(static_cast<std::size_t>(row) * size, size);
}

}  // namespace

void PaintOnPixels(const std::string& svg, double left_px, const PixelsToPaint& pixels) {
  const std::unique_ptr<cairo_surface_t, void (*)(cairo_surface_t*)> surface(
      cairo_image_surface_create(CAIRO_FORMAT_RGB24, pixels.width_px, pixels.height_px),
      cairo_surface_destroy);
  core::Require(cairo_surface_status(surface.get()) == CAIRO_STATUS_SUCCESS, "a picture can be painted on");
  for (int y = 0; y < pixels.height_px; ++y) {
    const std::span<const std::uint8_t> rgb = RowOf(pixels, y);
    const std::span<std::uint32_t> row = RowOf(surface.get(), y, pixels.width_px);
    for (std::size_t x = 0; x < row.size(); ++x)
      row[x] = 0xFF000000U | std::uint32_t{rgb[3 * x]} << 16U | std::uint32_t{rgb[3 * x + 1]} << 8U |
               rgb[3 * x + 2];
  }
  cairo_surface_mark_dirty(surface.get());
  {
    const std::unique_ptr<cairo_t, void (*)(cairo_t*)> cairo(cairo_create(surface.get()), cairo_destroy);
    const SvgDrawing drawing(svg, {});
    drawing.Draw(cairo.get(), {left_px + 0.5, 0.5, drawing.width_px(), drawing.height_px()});
  }
  cairo_surface_flush(surface.get());
  for (int y = 0; y < pixels.height_px; ++y) {
    const std::span<std::uint8_t> rgb = RowOf(pixels, y);
    const std::span<const std::uint32_t> row = RowOf(surface.get(), y, pixels.width_px);
    for (std::size_t x = 0; x < row.size(); ++x)
      for (std::size_t i = 0; i < 3; ++i)
        rgb[3 * x + i] = static_cast<std::uint8_t>(row[x] >> (16 - 8 * i) & 0xFFU);
  }
}

}  // namespace elbowroom::sessions
