#include "recon/gl/objects/texture.h"

#include <cstddef>

#include "core/error.h"

namespace elbowroom::recon::gl {
namespace {

// For the texture that is bound: each texel is read as it is.
void ReadTexelsAlone() {
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, 0);
}

}  // namespace

void FloatTexture::Upload(int width_px, int height_px, std::span<const float> floats) {
  UploadWithin(width_px, height_px, floats, {0, 0, width_px, height_px});
}

void FloatTexture::UploadWithin(int width_px, int height_px, std::span<const float> floats,
                                const TexelBox& texels) {
  core::Require(0 <= texels.x && texels.x < texels.right && texels.right <= width_px && 0 <= texels.y &&
                    texels.y < texels.bottom && texels.bottom <= height_px,
                "a texture is renewed within itself");
  core::Require(width_px > 0 && height_px > 0 &&
                    floats.size() == static_cast<std::size_t>(width_px) *
                                         static_cast<std::size_t>(height_px) *
                                         static_cast<std::size_t>(channels_),
                "a texture's floats match its size");
  const GLenum format = channels_ == 1 ? GL_RED : GL_RGB;
  glBindTexture(GL_TEXTURE_2D, texture_.get());
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  if (width_px == width_px_ && height_px == height_px_) {
    glPixelStorei(GL_UNPACK_ROW_LENGTH, width_px);
    glPixelStorei(GL_UNPACK_SKIP_PIXELS, texels.x);
    glPixelStorei(GL_UNPACK_SKIP_ROWS, texels.y);
    glTexSubImage2D(GL_TEXTURE_2D, 0, texels.x, texels.y, texels.right - texels.x, texels.bottom - texels.y,
                    format, GL_FLOAT, floats.data());
    for (const GLenum what : {GL_UNPACK_ROW_LENGTH, GL_UNPACK_SKIP_PIXELS, GL_UNPACK_SKIP_ROWS})
      glPixelStorei(what, 0);
    return;
  }
  glTexImage2D(GL_TEXTURE_2D, 0, channels_ == 1 ? GL_R32F : GL_RGB32F, width_px, height_px, 0, format,
               GL_FLOAT, floats.data());
  ReadTexelsAlone();
  width_px_ = width_px;
  height_px_ = height_px;
}

void FloatTexture::BindTo(int unit) const {
  glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
  glBindTexture(GL_TEXTURE_2D, texture_.get());
}

void ColorTexture::Upload(int width_px, int height_px, std::span<const std::array<std::uint8_t, 4>> texels) {
  core::Require(width_px > 0 && height_px > 0 &&
                    texels.size() == static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px),
                "a texture's texels match its size");
  glBindTexture(GL_TEXTURE_2D, texture_.get());
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, width_px, height_px, 0, GL_RGBA, GL_UNSIGNED_BYTE, texels.data());
  ReadTexelsAlone();
}

void ColorTexture::BindTo(int unit) const {
  glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
  glBindTexture(GL_TEXTURE_2D, texture_.get());
}

}  // namespace elbowroom::recon::gl
