// A hand at work before a rig, and a view of it: the scene with which speed and accuracy are measured.
#pragma once

#include <vector>

#include "core/camera_model.h"
#include "core/rig.h"
#include "core/soft_mask.h"
#include "recon/paper_methods/plane_sweep.h"
#include "recon/synthetic/solids.h"

namespace elbowroom::recon {

enum class ViewSceneRig {
  kPaper,  // PaperRig()
  kThree,  // FourCameraRig() less its last camera
  kFour,   // FourCameraRig()
  kEight   // EightCameraRig()
};

struct ViewScene {
  core::Rig rig;
  std::vector<SyntheticObject> objects;  // the demo's hand lowering its pipe
  core::CameraModel view;                // looks over the shoulder, without distortion
};

// The hull fills about 6 % of the view's pixels, whatever its size (synthetic_view_scene_test).
[[nodiscard]] ViewScene MakeViewScene(ViewSceneRig rig, int view_width_px = 640, int view_height_px = 480);

// 50 planes of the view with the paper's 15 mm between them, around the hand. `times`: this many times closer
// together, over the same depths.
[[nodiscard]] PlaneSweepOptions FiftyPlanes(int times = 1);

// The view's camera, looking at the scene's hand from the same place with another focal length, px.
[[nodiscard]] core::CameraModel HandView(int width_px, int height_px, double focal_px);

// The pixels whose centre ray hits an object, one mask a camera, without levels.
[[nodiscard]] std::vector<core::SoftMask> TrueMasks(const core::Rig& rig,
                                                    const std::vector<SyntheticObject>& objects);

}  // namespace elbowroom::recon
