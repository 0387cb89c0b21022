#include "recon/gl/objects/gl_error.h"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include "core/error.h"

namespace elbowroom::recon::gl {

void ThrowOnGlError(const std::string& renderer) {
  GLenum first = glGetError();
  if (first == GL_NO_ERROR) return;
  while (glGetError() != GL_NO_ERROR) {
  }
  throw core::Error(
      core::ErrorKind::kGraphics,
      fmt::format("drawing failed on {} ({}); ask for a smaller picture or fewer triangles", renderer,
                  first == GL_OUT_OF_MEMORY ? std::string("out of graphics memory")
                                            : fmt::format("OpenGL error {:#x}", first)));
}

void ThrowUnlessDrawable(const std::string& what) {
  const GLenum status = glCheckFramebufferStatus(GL_FRAMEBUFFER);
  if (status == GL_FRAMEBUFFER_COMPLETE) return;
  throw core::Error(
      core::ErrorKind::kGraphics,
      fmt::format("the graphics driver can't draw {} ({:#x}); ask for a smaller picture", what, status));
}

}  // namespace elbowroom::recon::gl
