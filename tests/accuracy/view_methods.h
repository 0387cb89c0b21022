// Every way to a picture of the hull, in one table: a new one is one line in view_methods.cc.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/camera_model.h"
#include "core/rig.h"
#include "core/soft_mask.h"
#include "recon/contours/undistorted_plane.h"
#include "recon/exact_view/view_rays.h"
#include "recon/hull/visual_hull.h"
#include "recon/images/depth_map.h"
#include "recon/paper_methods/sweep_rays.h"

namespace elbowroom::accuracy {

// Masks in memory and the camera that looks, with what belongs to the calibration alone: what the clock is
// started on.
struct ViewTask {
  ViewTask(std::shared_ptr<const core::Rig> rig, std::vector<core::SoftMask> masks, core::CameraModel view);

  [[nodiscard]] recon::VisualHull Hull() const { return recon::MakeVisualHull(rig, planes, masks); }

  std::shared_ptr<const core::Rig> rig;
  std::vector<core::SoftMask> masks;
  core::CameraModel view;
  recon::UndistortedPlanes planes;
  recon::ViewRays rays;
  recon::SweepRays sweep_rays;
};

struct ViewMethod {
  std::string family;   // methods of a family differ in one setting
  std::string setting;  // of that, with its unit
  std::function<recon::DepthMap(const ViewTask&)> view;

  [[nodiscard]] std::string Name() const { return family + ", " + setting; }
};

// Those in OpenGL keep their context: call them, and let go of them, on the thread that asked for them.
[[nodiscard]] std::vector<ViewMethod> ViewMethods();

// What the program itself makes of masks when it is asked for a view.
[[nodiscard]] recon::DepthMap ExactView(const ViewTask& task);

}  // namespace elbowroom::accuracy
