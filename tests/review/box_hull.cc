#include "tests/review/box_hull.h"

#include <Eigen/Core>
#include <memory>
#include <utility>
#include <vector>

#include "core/camera_model.h"
#include "core/rig.h"

namespace elbowroom::review {

using Eigen::Vector3d;

namespace {

// Object in [first, last)^2.
recon::VisualHull HullOfPixels(int first_px, int last_px) {
  core::Rig rig;
  rig.name = "box";
  rig.workspace_mm = {Vector3d::Constant(-95), Vector3d::Constant(95)};
  std::vector<core::BitMask> masks;
  for (const Vector3d& axis : {Vector3d(1, 0, 0), Vector3d(0, 1, 0), Vector3d(0, 0, 1)}) {
    core::CameraCalibration c;
    c.name = "far";
    c.image_width_px = c.image_height_px = 200;
    c.camera_matrix << 1e6, 0.0, 99.5, 0.0, 1e6, 99.5, 0.0, 0.0, 1.0;
    c.cam_from_world = core::CamFromWorldLookingAt(1e6 * axis, Vector3d::Zero());
    rig.cameras.emplace_back(std::move(c));
    core::BitMask& mask = masks.emplace_back(200, 200);
    for (int y = first_px; y < last_px; ++y)
      for (int x = first_px; x < last_px; ++x) mask.Set(x, y, true);
  }
  return recon::MakeVisualHull(std::make_shared<const core::Rig>(std::move(rig)), masks);
}

}  // namespace

recon::VisualHull BoxHull(bool is_empty) { return HullOfPixels(50, is_empty ? 50 : 150); }
recon::VisualHull FullHull() { return HullOfPixels(0, 200); }

}  // namespace elbowroom::review
