// Pictures that cairo draws: SVG by librsvg, and PNG.
#pragma once

#include <cairo.h>

#include <memory>
#include <span>
#include <string>

#include "sessions/print/printer.h"

// librsvg's own type, as its header declares it.
typedef struct _RsvgHandle RsvgHandle;  // NOLINT

namespace elbowroom::sessions {

struct Box {
  double x = 0.0;
  double y = 0.0;
  double width = 0.0;
  double height = 0.0;
};

// An SVG, read. Copies share it.
class SvgDrawing {
 public:
  // Throws: PreconditionError if it isn't one.
  SvgDrawing(const std::string& svg, const InkColors& inks);

  [[nodiscard]] double width_px() const { return width_px_; }
  [[nodiscard]] double height_px() const { return height_px_; }
  // Fills the box, in proportion.
  void Draw(cairo_t* cairo, const Box& box) const;

 private:
  std::shared_ptr<RsvgHandle> svg_;
  double width_px_ = 0.0;
  double height_px_ = 0.0;
};

class PngDrawing {
 public:
  // Throws: PreconditionError if these bytes are no PNG.
  explicit PngDrawing(std::span<const unsigned char> bytes);

  [[nodiscard]] double width_px() const { return cairo_image_surface_get_width(pixels_.get()); }
  [[nodiscard]] double height_px() const { return cairo_image_surface_get_height(pixels_.get()); }
  void Draw(cairo_t* cairo, const Box& box) const;

 private:
  std::shared_ptr<cairo_surface_t> pixels_;
};

}  // namespace elbowroom::sessions
