// Depths seen from a lamp, looked up with comparison. For the .cc files of this folder: it includes OpenGL.
#pragma once

#include <span>

#include "recon/gl/objects/gl_name.h"
#include "recon/gl/objects/object_kinds.h"

namespace elbowroom::recon::gl {

// A square texture of 32-bit depth-buffer values for a sampler2DShadow: a look-up compares with the four
// texels around and weighs the answers bilinearly; outside of the texture nothing is in the way.
class ShadowMap {
 public:
  ShadowMap();  // nothing is in the way anywhere

  // Row-major, side_px * side_px values in [0, 1]. Throws: PreconditionError when the count differs.
  void Upload(int side_px, std::span<const float> buffer_depth);

  // Empties it at that size and makes it the target of drawing. Throws: Error{kGraphics} when the driver
  // can't hold it.
  void BeginDrawing(int side_px);

  void BindTo(int unit) const;

 private:
  GlName<TextureKind> texture_;
  GlName<FramebufferKind> framebuffer_;
  int side_px_ = 0;
};

}  // namespace elbowroom::recon::gl
