#include "recon/gl/exact_view/hull_target.h"

#include <fmt/format.h>

#include <array>
#include <cstddef>

#include "recon/gl/objects/gl_error.h"

namespace elbowroom::recon::gl {
namespace {

constexpr GLenum kDepth = GL_COLOR_ATTACHMENT0;
constexpr GLenum kSurface = GL_COLOR_ATTACHMENT1;

}  // namespace

HullTarget::HullTarget(int width_px, int height_px) : width_px_(width_px), height_px_(height_px) {
  glBindRenderbuffer(GL_RENDERBUFFER, depth_.get());
  glRenderbufferStorage(GL_RENDERBUFFER, GL_R32F, width_px, height_px);
  glBindRenderbuffer(GL_RENDERBUFFER, surface_.get());
  glRenderbufferStorage(GL_RENDERBUFFER, GL_RG32I, width_px, height_px);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.get());
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, kDepth, GL_RENDERBUFFER, depth_.get());
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, kSurface, GL_RENDERBUFFER, surface_.get());
  ThrowUnlessDrawable(fmt::format("{} x {} pixels of depth", width_px, height_px));
}

void HullTarget::Bind(bool with_surfaces) const {
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.get());
  const std::array<GLenum, 2> targets{kDepth, kSurface};
  glDrawBuffers(with_surfaces ? 2 : 1, targets.data());
  glViewport(0, 0, width_px_, height_px_);
}

void HullTarget::Read(GLenum attachment, GLenum format, GLenum type, int x, int y, int right, int bottom,
                      void* pixels) const {
  glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_.get());
  glReadBuffer(attachment);
  glPixelStorei(GL_PACK_ALIGNMENT, 4);
  glPixelStorei(GL_PACK_ROW_LENGTH, width_px_);
  glReadPixels(x, y, right - x, bottom - y, format, type, pixels);
  glPixelStorei(GL_PACK_ROW_LENGTH, 0);
}

void HullTarget::ReadDepth(int x, int y, int right, int bottom, float* picture) const {
  const std::ptrdiff_t first = std::ptrdiff_t{y} * width_px_ + x;
  Read(kDepth, GL_RED, GL_FLOAT, x, y, right, bottom, picture + first);
}

void HullTarget::ReadSurfaces(int x, int y, int right, int bottom, GLint* picture) const {
  const std::ptrdiff_t first = std::ptrdiff_t{y} * width_px_ + x;
  Read(kSurface, GL_RG_INTEGER, GL_INT, x, y, right, bottom, picture + 2 * first);
}

}  // namespace elbowroom::recon::gl
