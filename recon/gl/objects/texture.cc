#include "recon/gl/objects/texture.h"

#include <cstddef>
#include <vector>

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

// Filled, so that software drivers take its memory now.
void FloatTexture::MakeRoom(const Eigen::Vector2i& room_px) {
  if (room_px == room_px_) return;
  const std::vector<float> nothing(static_cast<std::size_t>(room_px.x()) *
                                   static_cast<std::size_t>(room_px.y()) *
                                   static_cast<std::size_t>(channels_));
  glBindTexture(GL_TEXTURE_2D, texture_.get());
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  glTexImage2D(GL_TEXTURE_2D, 0, channels_ == 1 ? GL_R32F : GL_RGB32F, room_px.x(), room_px.y(), 0,
               channels_ == 1 ? GL_RED : GL_RGB, GL_FLOAT, nothing.data());
  ReadTexelsAlone();
  room_px_ = room_px;
  size_px_.setZero();
}

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
  const Eigen::Vector2i size_px(width_px, height_px);
  if ((size_px.array() > room_px_.array()).any()) MakeRoom(size_px.cwiseMax(room_px_));
  const TexelBox renewed = size_px == size_px_ ? texels : TexelBox{0, 0, width_px, height_px};
  glBindTexture(GL_TEXTURE_2D, texture_.get());
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  glPixelStorei(GL_UNPACK_ROW_LENGTH, width_px);
  glPixelStorei(GL_UNPACK_SKIP_PIXELS, renewed.x);
  glPixelStorei(GL_UNPACK_SKIP_ROWS, renewed.y);
  glTexSubImage2D(GL_TEXTURE_2D, 0, renewed.x, renewed.y, renewed.right - renewed.x,
                  renewed.bottom - renewed.y, channels_ == 1 ? GL_RED : GL_RGB, GL_FLOAT, floats.data());
  for (const GLenum what : {GL_UNPACK_ROW_LENGTH, GL_UNPACK_SKIP_PIXELS, GL_UNPACK_SKIP_ROWS})
    glPixelStorei(what, 0);
  size_px_ = size_px;
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
