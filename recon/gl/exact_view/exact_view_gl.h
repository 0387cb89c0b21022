// The exact view made by the graphics card.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "recon/exact_view/hull_view.h"

namespace elbowroom::recon::gl {

// Owns an OpenGL context. Move-only.
// Thread: every call, the destructor too, on the thread that made it. Several may live in a process.
class ExactViewGl {
 public:
  // Throws: core::Error{kGraphics} as EglContext, or when the driver refuses the shader.
  ExactViewGl();
  ~ExactViewGl();
  ExactViewGl(ExactViewGl&&) noexcept;
  ExactViewGl& operator=(ExactViewGl&&) noexcept;

  // As recon::ViewHull, and equal to it outside ViewBand: hit or miss, and the depth to 1e-5 of itself
  // (exact_view_gl_test, docs/exact_view_gl.md). `crossings_met` isn't counted. If the same view was drawn
  // last it is only read again; if the rays are the same they aren't uploaded again. Throws:
  // core::Error{kGraphics} when the driver fails or can't hold that many edges.
  [[nodiscard]] HullView ViewHull(const VisualHull& hull, const ViewRays& rays,
                                  const HullViewOptions& options = {});

  // Driver's vendor, renderer and version in one line.
  [[nodiscard]] const std::string& driver() const;

  // Since the start: pictures drawn, and tables of rays brought to the card.
  [[nodiscard]] std::int64_t draws() const;
  [[nodiscard]] std::int64_t ray_uploads() const;

 private:
  class Impl;
  [[nodiscard]] Impl& OnOwnThread() const;
  std::unique_ptr<Impl> impl_;
};

}  // namespace elbowroom::recon::gl
