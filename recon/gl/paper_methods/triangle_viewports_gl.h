// The paper's collision detection in OpenGL.
#pragma once

#include <memory>
#include <string>

#include "recon/paper_methods/triangle_viewports.h"

namespace elbowroom::recon::gl {

// Owns an OpenGL context. Move-only.
// Thread: every call, the destructor too, on the thread that made it.
class TriangleViewportsGl {
 public:
  // Throws: core::Error{kGraphics} as EglContext.
  TriangleViewportsGl();
  ~TriangleViewportsGl();
  TriangleViewportsGl(TriangleViewportsGl&&) noexcept;
  TriangleViewportsGl& operator=(TriangleViewportsGl&&) noexcept;

  // As recon::SampleTriangles: the same samples with the same labels, except where rounding decides, as in
  // PlaneSweepGl (docs/paper_collision.md; triangle_viewports_gl_test). The viewports lie side by side on a
  // page, or on several if one is too small. The triangles are drawn once for each camera, with its
  // silhouette projected on them. The stencil buffer counts the cameras that label a sample object and is
  // then read back. Throws: as SampleTriangles, and core::Error{kGraphics} when the driver fails.
  [[nodiscard]] SampledContacts Sample(const CoverageHull& hull, const core::TriangleMesh& part,
                                       const core::RigidTransform& world_from_part,
                                       const TriangleViewportOptions& options = {});

  // Driver's vendor, renderer and version in one line.
  [[nodiscard]] const std::string& driver() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace elbowroom::recon::gl
