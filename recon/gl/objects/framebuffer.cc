#include "recon/gl/objects/framebuffer.h"

#include <fmt/format.h>

#include "core/error.h"
#include "recon/gl/objects/gl_error.h"

namespace elbowroom::recon::gl {
namespace {

void Allocate(GLuint renderbuffer, int samples, GLenum format, int width_px, int height_px) {
  glBindRenderbuffer(GL_RENDERBUFFER, renderbuffer);
  glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples > 1 ? samples : 0, format, width_px, height_px);
}

}  // namespace

Framebuffer::Framebuffer(int width_px, int height_px, int samples)
    : width_px_(width_px), height_px_(height_px) {
  Allocate(colour_.get(), samples, GL_RGBA8, width_px, height_px);
  Allocate(depth_.get(), samples, GL_DEPTH24_STENCIL8, width_px, height_px);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.get());
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, colour_.get());
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_STENCIL_ATTACHMENT, GL_RENDERBUFFER, depth_.get());
  ThrowUnlessDrawable(fmt::format("{} x {} pixels with {} samples", width_px, height_px, samples));
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
}

void Framebuffer::Bind(int picture_width_px, int picture_height_px) const {
  core::Require(picture_width_px <= width_px_ && picture_height_px <= height_px_,
                "a picture fits its framebuffer");
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.get());
  glViewport(0, 0, picture_width_px, picture_height_px);
}

void Framebuffer::BindForReading() const { glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_.get()); }

void Framebuffer::BindForDrawing() const { glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer_.get()); }

void Framebuffer::ResolveColourFrom(const Framebuffer& source, int picture_width_px,
                                    int picture_height_px) const {
  core::Require(source.width_px_ == width_px_ && source.height_px_ == height_px_,
                "framebuffers to resolve have one size");
  glBindFramebuffer(GL_READ_FRAMEBUFFER, source.framebuffer_.get());
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer_.get());
  glBlitFramebuffer(0, 0, picture_width_px, picture_height_px, 0, 0, picture_width_px, picture_height_px,
                    GL_COLOR_BUFFER_BIT, GL_NEAREST);
}

}  // namespace elbowroom::recon::gl
