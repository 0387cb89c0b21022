#include "recon/gl/scene/shadow_map.h"

#include <fmt/format.h>

#include <array>
#include <cstddef>

#include "core/error.h"
#include "recon/gl/objects/gl_error.h"

namespace elbowroom::recon::gl {

ShadowMap::ShadowMap() {
  glBindTexture(GL_TEXTURE_2D, texture_.get());
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, 0);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_BORDER);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_BORDER);
  constexpr std::array<GLfloat, 4> kFarthest{1.0F, 1.0F, 1.0F, 1.0F};
  glTexParameterfv(GL_TEXTURE_2D, GL_TEXTURE_BORDER_COLOR, kFarthest.data());
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
  Upload(1, std::array{1.0F});
}

void ShadowMap::Upload(int side_px, std::span<const float> buffer_depth) {
  core::Require(side_px > 0 && buffer_depth.size() ==
                                   static_cast<std::size_t>(side_px) * static_cast<std::size_t>(side_px),
                "a shadow map's depths match its size");
  glBindTexture(GL_TEXTURE_2D, texture_.get());
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT32F, side_px, side_px, 0, GL_DEPTH_COMPONENT, GL_FLOAT,
               buffer_depth.data());
  side_px_ = side_px;
}

void ShadowMap::BeginDrawing(int side_px) {
  if (side_px != side_px_) {
    glBindTexture(GL_TEXTURE_2D, texture_.get());
    glTexImage2D(GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT32F, side_px, side_px, 0, GL_DEPTH_COMPONENT, GL_FLOAT,
                 nullptr);
    side_px_ = side_px;
  }
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.get());
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, texture_.get(), 0);
  glDrawBuffer(GL_NONE);
  glReadBuffer(GL_NONE);
  ThrowUnlessDrawable(fmt::format("a shadow of {0} x {0} texels", side_px));
  glViewport(0, 0, side_px, side_px);
  glClear(GL_DEPTH_BUFFER_BIT);
}

void ShadowMap::BindTo(int unit) const {
  glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
  glBindTexture(GL_TEXTURE_2D, texture_.get());
  glActiveTexture(GL_TEXTURE0);  // uploads bind where they please
}

}  // namespace elbowroom::recon::gl
