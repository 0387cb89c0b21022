#include "app/control/self_test.h"

#include <algorithm>
#include <utility>

#include "recon/gl/plane_sweep_gl.h"
#include "recon/straightened_mask.h"
#include "recon/sweep_comparison.h"
#include "recon/synthetic/demo_motion.h"
#include "recon/synthetic/rig_presets.h"
#include "recon/synthetic/synthetic_rig.h"

namespace elbowroom::control {
namespace {

constexpr double kHandOverTheTableS = 3.0;
constexpr int kGrid = 5;  // the paper's

struct Scene {
  core::Rig rig;
  std::vector<core::SoftMask> masks;
  core::CameraModel view;
};

core::CameraModel OperatorsView() {
  core::CameraCalibration view;
  view.name = "view";
  view.image_width_px = 320;
  view.image_height_px = 240;
  view.camera_matrix << 360.0, 0.0, 159.5, 0.0, 360.0, 119.5, 0.0, 0.0, 1.0;
  view.cam_from_world = core::CamFromWorldLookingAt({500.0, -900.0, 650.0}, {60.0, 0.0, 200.0});
  return core::CameraModel(std::move(view));
}

Scene HandScene() {
  const std::vector<recon::SyntheticObject> objects = recon::DemoSceneAt(kHandOverTheTableS).objects;
  Scene scene{recon::FourCameraRig(), {}, OperatorsView()};
  const recon::SyntheticRig cameras(scene.rig, [&](double) { return objects; });
  for (core::BitMask& mask : cameras.TrueMasks(objects)) scene.masks.push_back({std::move(mask), {}});
  return scene;
}

// The rig of ideal cameras that a sweep with a grid is a sweep of.
Scene Straightened(const Scene& scene) {
  Scene straight{scene.rig, {}, scene.view};
  straight.rig.cameras.clear();
  for (std::size_t i = 0; i < scene.masks.size(); ++i) {
    recon::StraightenedMask mask = recon::Straighten(scene.rig.cameras[i], scene.masks[i], kGrid, false);
    straight.rig.cameras.push_back(std::move(mask.camera));
    straight.masks.push_back(std::move(mask.mask));
  }
  return straight;
}

SelfTestLine Compare(const std::string& what, const Scene& scene, recon::gl::SweepPasses passes,
                     recon::gl::PlaneSweepGl* sweep) {
  const recon::SweepRays rays(scene.view);
  const recon::SweptView cpu = recon::SweepPlanes(scene.rig, scene.masks, scene.view, rays);
  const recon::SweptView gl = sweep->Sweep(scene.rig, scene.masks, scene.view, rays, {}, passes);
  const recon::SweepComparison comparison =
      recon::CompareSweeps(scene.rig, scene.masks, scene.view, cpu.picture, gl.picture);
  return {what, cpu.picture.hit_pixels, comparison.differing_pixels, comparison.unexplained_pixels};
}

}  // namespace

bool SelfTestReport::Passed() const {
  return std::all_of(lines.begin(), lines.end(), [](const SelfTestLine& line) {
    return line.hit_pixels > 0 && line.unexplained_pixels == 0;
  });
}

SelfTestReport RunSelfTest() {
  recon::gl::PlaneSweepGl sweep;
  const Scene scene = HandScene(), straight = Straightened(scene);
  SelfTestReport report{sweep.driver(), {}};
  for (const auto& [passes, name] :
       {std::pair{recon::gl::SweepPasses::kOneAPlane, "a draw a plane"},
        std::pair{recon::gl::SweepPasses::kOneAPlaneAndCamera, "the paper's passes"}}) {
    report.lines.push_back(Compare(std::string("plane sweep, ") + name, scene, passes, &sweep));
    report.lines.push_back(
        Compare(std::string("plane sweep, undistortion grid, ") + name, straight, passes, &sweep));
  }
  return report;
}

}  // namespace elbowroom::control
