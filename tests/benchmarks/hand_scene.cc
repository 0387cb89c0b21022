#include "tests/benchmarks/hand_scene.h"

#include <algorithm>
#include <utility>

#include "core/rigid_transform.h"
#include "recon/synthetic/demo_motion.h"
#include "recon/synthetic/rig_presets.h"
#include "recon/synthetic/synthetic_rig.h"

namespace elbowroom::benchmarks {
namespace {

constexpr double kHandOverTheTableS = 3.0;

core::CameraModel OperatorsView() {
  core::CameraCalibration view;
  view.name = "view";
  view.image_width_px = 640;
  view.image_height_px = 480;
  view.camera_matrix << 720.0, 0.0, 319.5, 0.0, 720.0, 239.5, 0.0, 0.0, 1.0;
  view.cam_from_world = core::CamFromWorldLookingAt({500.0, -900.0, 650.0}, {60.0, 0.0, 200.0});
  return core::CameraModel(std::move(view));
}

}  // namespace

HandScene MakeHandScene(int cameras) {
  core::Rig rig = cameras > 4 ? recon::EightCameraRig() : recon::FourCameraRig();
  rig.cameras.erase(rig.cameras.begin() + std::min<std::ptrdiff_t>(cameras, std::ssize(rig.cameras)),
                    rig.cameras.end());
  std::vector<recon::SyntheticObject> objects = recon::DemoSceneAt(kHandOverTheTableS).objects;
  std::erase_if(objects, [](const recon::SyntheticObject& object) { return object.name != "hand"; });
  const recon::SyntheticRig cameras_of_rig(rig, [&](double) { return objects; });
  HandScene scene{std::move(rig), {}, OperatorsView()};
  for (core::BitMask& mask : cameras_of_rig.TrueMasks(objects)) scene.masks.push_back({std::move(mask), {}});
  return scene;
}

}  // namespace elbowroom::benchmarks
