// An image of bytes on the graphics card. For the .cc files of this folder: it includes OpenGL.
#pragma once

#include <cstdint>
#include <span>

#include "recon/gl/objects/gl_name.h"
#include "recon/gl/objects/object_kinds.h"

namespace elbowroom::recon::gl {

// One byte a texel, 255 read as 1, interpolated bilinearly; beyond the edge it repeats the texels at the
// edge.
class ByteTexture {
 public:
  // Row-major. Throws: PreconditionError when there are fewer bytes than texels.
  void Upload(int width_px, int height_px, std::span<const std::uint8_t> bytes);

  void BindTo(int unit) const;

 private:
  GlName<TextureKind> texture_;
};

}  // namespace elbowroom::recon::gl
