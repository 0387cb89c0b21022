// A framebuffer that pictures are drawn to. For the .cc files of this folder: it includes OpenGL.
#pragma once

#include "recon/gl/objects/gl_name.h"
#include "recon/gl/objects/object_kinds.h"

namespace elbowroom::recon::gl {

// 8-bit RGBA, 24-bit depth and 8-bit stencil, `samples` a pixel (1: none but the pixel's centre). Pictures
// take its lower left corner, as much of it as they need.
class Framebuffer {
 public:
  // Emptied, so that software drivers take its memory now. Throws: Error{kGraphics} when the driver can't
  // hold it.
  Framebuffer(int width_px, int height_px, int samples);

  [[nodiscard]] int width_px() const { return width_px_; }
  [[nodiscard]] int height_px() const { return height_px_; }

  // For drawing a picture of that size, with the viewport over it.
  void Bind(int picture_width_px, int picture_height_px) const;
  void BindForReading() const;
  void BindForDrawing() const;  // leaves the viewport, and the framebuffer for reading

  // Averages the samples of a picture of that size in `source`, whose size is this one's, into its colour.
  void ResolveColourFrom(const Framebuffer& source, int picture_width_px, int picture_height_px) const;

 private:
  int width_px_;
  int height_px_;
  GlName<RenderbufferKind> colour_;
  GlName<RenderbufferKind> depth_;
  GlName<FramebufferKind> framebuffer_;
};

}  // namespace elbowroom::recon::gl
