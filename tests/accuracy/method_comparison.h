// Run time against error of every way to a view.
#pragma once

#include <string>
#include <vector>

#include "recon/synthetic/view_scene.h"
#include "tests/accuracy/depth_error.h"
#include "tests/accuracy/interleaved_timing.h"
#include "tests/accuracy/view_methods.h"

namespace elbowroom::accuracy {

// A scene with its masks, and two references: the hull of those masks by brute force, and the hull of the
// solids.
struct ComparedScene {
  std::string name;
  ViewTask task;
  SurfacePicture mask_hull;
  SurfacePicture analytic_hull;
};

// Both references at every pixel of the view: a minute at 640 x 480.
[[nodiscard]] ComparedScene MakeComparedScene(const std::string& name, recon::ViewSceneRig rig,
                                              int view_width_px, int view_height_px);

struct MethodResult {
  ViewMethod method;
  DepthError to_mask_hull;
  DepthError to_analytic_hull;
  Timing one_thread;
  Timing two_threads;
};

[[nodiscard]] std::vector<MethodResult> CompareMethods(const ComparedScene& scene,
                                                       const TimingEffort& effort = {});

}  // namespace elbowroom::accuracy
