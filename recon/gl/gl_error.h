// What OpenGL has to say after a piece of work.
#pragma once

#include <string>

namespace elbowroom::recon::gl {

// Throws: core::Error{kGraphics} naming the renderer for the first error since the last call, if there is
// one.
void ThrowOnGlError(const std::string& renderer);

}  // namespace elbowroom::recon::gl
