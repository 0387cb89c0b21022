// The paper's set-up of the plane sweep, and what a frame of it costs by every way to see the same hull.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "recon/segmentation/segmentation.h"
#include "tests/accuracy/depth_error.h"
#include "tests/accuracy/interleaved_timing.h"

namespace elbowroom::accuracy {

inline constexpr int kPaperCells = 5;  // along a side of a plane, whose lens is corrected at their corners

// A way to see, from pictures in memory to depths, as it was counted and timed.
struct SweepWork {
  std::string method;
  std::int64_t planes = 0;     // 0: it has none
  std::int64_t triangles = 0;  // drawn; 0 on the processor
  // Drawn by OpenGL; on the processor points of planes asked of the cameras; of the exact view rays cast.
  std::int64_t filled_pixels = 0;
  Timing one_thread, two_threads;  // with the segmentation
  DepthError to_mask_hull, to_analytic_hull;
};

struct SweepWorkResult {
  recon::SegmentationStats segmented;  // of a frame's pictures
  Timing one_thread, two_threads;      // of the segmentation alone
  std::vector<SweepWork> methods;      // the paper's first
};

// The paper's rig (three fields of 720 x 243), the demo's hand, a view of 320 x 240 and 50 planes of 15 mm.
// Pictures have noise of 1.5 levels; masks are segmented from them. The error is against the brute-force hull
// of these masks, and against the hull that perfect cameras would have seen. `view_width_px` by three
// quarters of it. OpenGL may take threads of its own.
[[nodiscard]] SweepWorkResult TimeSweepWork(const TimingEffort& effort = {}, int view_width_px = 320);

}  // namespace elbowroom::accuracy
