#include "recon/gl/paper_methods/plane_target.h"

#include <fmt/format.h>

#include "recon/gl/objects/gl_error.h"

namespace elbowroom::recon::gl {

PlaneTarget::PlaneTarget(int width_px, int height_px) : width_px_(width_px), height_px_(height_px) {
  glBindRenderbuffer(GL_RENDERBUFFER, depth_stencil_.get());
  glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH24_STENCIL8, width_px, height_px);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.get());
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_STENCIL_ATTACHMENT, GL_RENDERBUFFER,
                            depth_stencil_.get());
  glDrawBuffer(GL_NONE);
  glReadBuffer(GL_NONE);
  ThrowUnlessDrawable(fmt::format("planes of {} x {} pixels", width_px, height_px));
}

void PlaneTarget::Bind() const {
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.get());
  glViewport(0, 0, width_px_, height_px_);
}

}  // namespace elbowroom::recon::gl
