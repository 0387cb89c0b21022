// Every way to a picture of the hull, in one table: a new one is one line in view_methods.cc.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/bit_mask.h"
#include "core/camera_model.h"
#include "core/rig.h"
#include "recon/depth_map.h"

namespace elbowroom::accuracy {

// Masks in memory and the camera that looks; what the clock is started on.
struct ViewTask {
  std::shared_ptr<const core::Rig> rig;
  std::span<const core::BitMask> masks;
  core::CameraModel view;
};

struct ViewMethod {
  std::string family;   // methods of a family differ in one setting
  std::string setting;  // of that, with its unit
  std::function<recon::DepthMap(const ViewTask&)> view;

  [[nodiscard]] std::string Name() const { return family + ", " + setting; }
};

[[nodiscard]] std::vector<ViewMethod> ViewMethods();

// What the program itself makes of masks when it is asked for a view.
[[nodiscard]] recon::DepthMap ExactView(const ViewTask& task);

}  // namespace elbowroom::accuracy
