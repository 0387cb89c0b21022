// The paper's plane sweep: the first of a stack of planes on which every camera sees object, for every pixel.
#pragma once

#include <cstdint>
#include <span>

#include "core/rig.h"
#include "core/soft_mask.h"
#include "recon/images/depth_map.h"
#include "recon/paper_methods/sweep_rays.h"

namespace elbowroom::recon {

// Planes stand at the whole multiples of `spacing_mm` along the view's z axis, as far as workspace, `near_mm`
// and `far_mm` (both included) let them.
struct PlaneSweepOptions {
  double spacing_mm = 15.0;  // > 0; the paper's
  double near_mm = 0.0;
  double far_mm = 1e9;
  // 0: every point goes through the cameras' lenses. n >= 1: every plane is divided into n x n cells (the
  // paper: 5), whose corners alone go through the lenses; between them the picture is projected without lens
  // (plane_grid.h). The result is off by the grid's error. Every plane is then asked point by point.
  int undistortion_grid = 0;
  // CPU only. False: the plain sweep, for comparison. It leaves out tiles that show no hull and ends a tile
  // when all its pixels are hit, but asks every plane point by point. The picture is the same.
  bool settles_regions = true;

  // Throws: PreconditionError naming the field out of range.
  void Validate() const;
};

struct PlaneSweepStats {
  std::int64_t planes = 0;         // in the stack
  std::int64_t tested_points = 0;  // places on planes whose projections were looked up
  std::int64_t skipped_points =
      0;  // the rest of planes * pixels: hit already, or settled with their neighbours
  // The work in the paper's terms ("Analysis, Performance"), counted where it is done, in OpenGL alone.
  std::int64_t drawn_triangles = 0;
  std::int64_t filled_pixels = 0;  // by all draws
};

struct SweptView {
  DepthMap picture;
  PlaneSweepStats stats;
};

// The sweep on the CPU (docs/plane_sweep.md; paper, "Volume-Querying"): for every pixel the depth of the
// first plane on which the ray's point is object in every camera, by the rig's `unseen` policy, and in the
// workspace; 0 where there is none. Labels are the soft masks' (recon/paper_methods/coverage_texture.h);
// where rounding decides, within docs/plane_sweep.md's band, either answer is possible (plane_sweep_test
// holds it to an oracle). Planes and pixels that can't change the answer are skipped; the result doesn't
// depend on that nor on the number of threads. A hull thinner than the spacing can be missed. `rays` are
// those of `view`'s lens; make them once for a lens whose pose changes. Throws: core::Error{kCamera} naming
// the camera when a mask's size isn't the camera's; Error{kRange} for more than 64 cameras or 100,000 planes;
// PreconditionError for options out of range or not one mask a camera.
[[nodiscard]] SweptView SweepPlanes(const core::Rig& rig, std::span<const core::SoftMask> masks,
                                    const core::CameraModel& view, const SweepRays& rays,
                                    const PlaneSweepOptions& options = {});
[[nodiscard]] SweptView SweepPlanes(const core::Rig& rig, std::span<const core::SoftMask> masks,
                                    const core::CameraModel& view, const PlaneSweepOptions& options = {});

}  // namespace elbowroom::recon
