// Run time against error of every way to a view.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/bit_mask.h"
#include "recon/synthetic/view_scene.h"
#include "tests/accuracy/depth_error.h"
#include "tests/accuracy/interleaved_timing.h"
#include "tests/accuracy/view_methods.h"

namespace elbowroom::accuracy {

// A scene with its masks, and two references: the hull of those masks by brute force, and the hull of the
// solids.
struct ComparedScene {
  std::string name;
  std::shared_ptr<const core::Rig> rig;
  std::vector<core::BitMask> masks;
  core::CameraModel view;
  SurfacePicture mask_hull;
  SurfacePicture analytic_hull;

  [[nodiscard]] ViewTask Task() const { return {rig, masks, view}; }
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
