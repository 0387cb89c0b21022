// OpenGL's errors as exceptions.
#pragma once

#include <string>

namespace elbowroom::recon::gl {

// Throws: core::Error{kGraphics} naming the renderer for the first error since the last call, if there is
// one.
void ThrowOnGlError(const std::string& renderer);

// Throws: core::Error{kGraphics} when the driver can't draw to the framebuffer that is bound; `what` as in
// "planes of 640 x 480 pixels".
void ThrowUnlessDrawable(const std::string& what);

}  // namespace elbowroom::recon::gl
