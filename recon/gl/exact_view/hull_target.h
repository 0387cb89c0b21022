// Where the exact view is drawn. For the .cc files of this folder: it includes OpenGL.
#pragma once

#include "recon/gl/objects/gl_name.h"
#include "recon/gl/objects/object_kinds.h"

namespace elbowroom::recon::gl {

// A float of depth and two integers of surface a pixel; row 0 is the picture's top.
class HullTarget {
 public:
  // Throws: core::Error{kGraphics} when the driver can't hold it.
  HullTarget(int width_px, int height_px);

  [[nodiscard]] int width_px() const { return width_px_; }
  [[nodiscard]] int height_px() const { return height_px_; }

  // For drawing, with the viewport over all of it; without surfaces, what a shader writes of them is dropped.
  void Bind(bool with_surfaces) const;

  // Pixels [x, right) x [y, bottom) into their places in a picture of the same size: one float, or two
  // integers, a pixel.
  void ReadDepth(int x, int y, int right, int bottom, float* picture) const;
  void ReadSurfaces(int x, int y, int right, int bottom, GLint* picture) const;

 private:
  void Read(GLenum attachment, GLenum format, GLenum type, int x, int y, int right, int bottom,
            void* pixels) const;

  int width_px_;
  int height_px_;
  GlName<RenderbufferKind> depth_;
  GlName<RenderbufferKind> surface_;
  GlName<FramebufferKind> framebuffer_;
};

}  // namespace elbowroom::recon::gl
