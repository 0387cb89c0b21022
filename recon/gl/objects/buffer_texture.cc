#include "recon/gl/objects/buffer_texture.h"

#include <fmt/format.h>

#include "core/error.h"

namespace elbowroom::recon::gl {

BufferTexture::BufferTexture(GLenum format, std::size_t texel_bytes) : texel_bytes_(texel_bytes) {
  glBindBuffer(GL_TEXTURE_BUFFER, buffer_.get());
  glBindTexture(GL_TEXTURE_BUFFER, texture_.get());
  glTexBuffer(GL_TEXTURE_BUFFER, format, buffer_.get());
}

void BufferTexture::Upload(std::span<const std::byte> bytes) {
  core::Require(bytes.size() % texel_bytes_ == 0, "an upload holds whole texels");
  GLint most = 0;
  glGetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &most);
  const std::size_t texels = bytes.size() / texel_bytes_;
  if (texels > static_cast<std::size_t>(most)) {
    throw core::Error(core::ErrorKind::kGraphics,
                      fmt::format("the graphics driver holds tables of {} entries, the hull's edges need {}; "
                                  "take the view that the processor makes",
                                  most, texels));
  }
  glBindBuffer(GL_TEXTURE_BUFFER, buffer_.get());
  glBufferData(GL_TEXTURE_BUFFER, static_cast<GLsizeiptr>(bytes.size()), bytes.data(), GL_STREAM_DRAW);
}

void BufferTexture::BindTo(int unit) const {
  glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
  glBindTexture(GL_TEXTURE_BUFFER, texture_.get());
}

}  // namespace elbowroom::recon::gl
