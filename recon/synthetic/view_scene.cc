#include "recon/synthetic/view_scene.h"

#include "recon/synthetic/camera_view.h"
#include "recon/synthetic/demo_motion.h"
#include "recon/synthetic/rig_presets.h"

namespace elbowroom::recon {
namespace {

constexpr double kSceneTimeS = 5.0;
// Focal length over the view's height: the hull then fills about 6 % of the picture.
constexpr double kFocalShare = 1.02;

core::Rig RigOf(ViewSceneRig rig) {
  if (rig == ViewSceneRig::kPaper) return PaperRig();
  if (rig == ViewSceneRig::kEight) return EightCameraRig();
  core::Rig four = FourCameraRig();
  if (rig == ViewSceneRig::kThree) {
    four.name = "three_modern";
    four.cameras.pop_back();
  }
  return four;
}

}  // namespace

PlaneSweepOptions FiftyPlanes(int times) {
  constexpr double kSpacingMm = 15.0, kNearMm = 450.0, kFarMm = kNearMm + 49.0 * kSpacingMm;
  return {.spacing_mm = kSpacingMm / times, .near_mm = kNearMm, .far_mm = kFarMm};
}

core::CameraModel HandView(int width_px, int height_px, double focal_px) {
  core::CameraCalibration view;
  view.name = "view";
  view.image_width_px = width_px;
  view.image_height_px = height_px;
  view.camera_matrix << focal_px, 0.0, 0.5 * (width_px - 1), 0.0, focal_px, 0.5 * (height_px - 1), 0.0, 0.0,
      1.0;
  view.distortion_coefficients = {0.0, 0.0, 0.0, 0.0, 0.0};
  view.cam_from_world = core::CamFromWorldLookingAt({520.0, -560.0, 640.0}, {140.0, 10.0, 200.0});
  return core::CameraModel(std::move(view));
}

ViewScene MakeViewScene(ViewSceneRig rig, int view_width_px, int view_height_px) {
  return {RigOf(rig), DemoSceneAt(kSceneTimeS).objects,
          HandView(view_width_px, view_height_px, kFocalShare * view_height_px)};
}

std::vector<core::SoftMask> TrueMasks(const core::Rig& rig, const std::vector<SyntheticObject>& objects) {
  const std::vector<Solid> solids = AllSolids(objects);
  std::vector<core::SoftMask> masks;
  for (const core::CameraModel& camera : rig.cameras)
    masks.push_back({CameraView(camera, 1).TrueMask(solids), {}});
  return masks;
}

}  // namespace elbowroom::recon
