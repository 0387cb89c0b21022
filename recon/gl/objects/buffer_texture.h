// A table on the graphics card. For the .cc files of this folder: it includes OpenGL.
#pragma once

#include <cstddef>
#include <span>

#include "recon/gl/objects/gl_name.h"
#include "recon/gl/objects/object_kinds.h"

namespace elbowroom::recon::gl {

// Texels in a row, read with texelFetch from a samplerBuffer or usamplerBuffer.
class BufferTexture {
 public:
  // `format`: such as GL_RGBA32F; one of its texels takes `texel_bytes`.
  BufferTexture(GLenum format, std::size_t texel_bytes);

  template <typename Texel>
  void Upload(std::span<const Texel> texels) {
    Upload(std::as_bytes(texels));
  }
  // Throws: PreconditionError when `bytes` isn't whole texels; core::Error{kGraphics} when the driver's
  // buffers don't hold that many.
  void Upload(std::span<const std::byte> bytes);

  void BindTo(int unit) const;

 private:
  GlName<BufferKind> buffer_;
  GlName<TextureKind> texture_;
  std::size_t texel_bytes_;
};

}  // namespace elbowroom::recon::gl
