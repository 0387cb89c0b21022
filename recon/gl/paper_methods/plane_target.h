// Where planes are drawn: depth and stencil, no colour. For the .cc files of this folder: it includes OpenGL.
#pragma once

#include "recon/gl/objects/gl_name.h"
#include "recon/gl/objects/object_kinds.h"

namespace elbowroom::recon::gl {

// 24-bit depth and 8-bit stencil.
class PlaneTarget {
 public:
  // Throws: core::Error{kGraphics} when the driver can't hold it.
  PlaneTarget(int width_px, int height_px);

  [[nodiscard]] int width_px() const { return width_px_; }
  [[nodiscard]] int height_px() const { return height_px_; }

  // For drawing and reading, with the viewport over all of it.
  void Bind() const;

 private:
  int width_px_;
  int height_px_;
  GlName<RenderbufferKind> depth_stencil_;
  GlName<FramebufferKind> framebuffer_;
};

}  // namespace elbowroom::recon::gl
