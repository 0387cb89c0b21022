#include "recon/gl/objects/byte_texture.h"

#include <cstddef>

#include "core/error.h"

namespace elbowroom::recon::gl {

void ByteTexture::Upload(int width_px, int height_px, std::span<const std::uint8_t> bytes) {
  core::Require(width_px > 0 && height_px > 0 &&
                    bytes.size() >= static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px),
                "a texture has a byte a texel");
  glBindTexture(GL_TEXTURE_2D, texture_.get());
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_R8, width_px, height_px, 0, GL_RED, GL_UNSIGNED_BYTE, bytes.data());
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, 0);
}

void ByteTexture::BindTo(int unit) const {
  glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
  glBindTexture(GL_TEXTURE_2D, texture_.get());
}

}  // namespace elbowroom::recon::gl
