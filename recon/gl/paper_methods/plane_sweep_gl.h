// The paper's plane sweep in OpenGL.
#pragma once

#include <memory>
#include <span>
#include <string>

#include "recon/paper_methods/plane_sweep.h"

namespace elbowroom::recon::gl {

enum class SweepPasses {
  // All cameras' textures in one draw a plane, cut to where the hull can be (groups of at most 15 cameras).
  kOneAPlane,
  // The paper's way: every camera draws every plane over the whole picture. Points that it labels object are
  // counted in the stencil buffer, and a last pass keeps the depth where all cameras have counted.
  kOneAPlaneAndCamera,
};

// Owns an OpenGL context. Move-only.
// Thread: every call, the destructor too, on the thread that made it.
class PlaneSweepGl {
 public:
  // Throws: core::Error{kGraphics} as EglContext.
  PlaneSweepGl();
  ~PlaneSweepGl();
  PlaneSweepGl(PlaneSweepGl&&) noexcept;
  PlaneSweepGl& operator=(PlaneSweepGl&&) noexcept;

  // As recon::SweepPlanes, and equal to it pixel by pixel, except where rounding decides: textures are
  // interpolated with 8-bit fractions, so that labels may differ where the coverage is within 4/256 of one
  // half (docs/plane_sweep.md; plane_sweep_gl_test). An undistortion grid needs kOneAPlaneAndCamera. Throws:
  // as SweepPlanes, PreconditionError for a grid with kOneAPlane, and core::Error{kGraphics} when the driver
  // fails.
  [[nodiscard]] SweptView Sweep(const core::Rig& rig, std::span<const core::SoftMask> masks,
                                const core::CameraModel& view, const SweepRays& rays,
                                const PlaneSweepOptions& options = {},
                                SweepPasses passes = SweepPasses::kOneAPlane);

  // Driver's vendor, renderer and version in one line.
  [[nodiscard]] const std::string& driver() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace elbowroom::recon::gl
