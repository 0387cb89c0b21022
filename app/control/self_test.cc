#include "app/control/self_test.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>
#include <utility>

#include "app/control/demo_parts.h"
#include "recon/contours/undistorted_plane.h"
#include "recon/exact_view/hull_view.h"
#include "recon/exact_view/view_comparison.h"
#include "recon/gl/exact_view/exact_view_gl.h"
#include "recon/gl/paper_methods/plane_sweep_gl.h"
#include "recon/gl/paper_methods/triangle_viewports_gl.h"
#include "recon/hull/visual_hull.h"
#include "recon/paper_methods/sweep_comparison.h"
#include "recon/synthetic/demo_motion.h"
#include "recon/synthetic/rig_presets.h"
#include "recon/synthetic/view_scene.h"

namespace elbowroom::control {
namespace {

constexpr double kHandOverTheTableS = 3.0;
constexpr int kGrid = 5;  // the paper's

struct Scene {
  core::Rig rig;
  std::vector<core::SoftMask> masks;
  core::CameraModel view;
};

const Eigen::Vector3d kOperatorsEye(500.0, -900.0, 650.0), kHand(60.0, 0.0, 200.0);

core::CameraCalibration OperatorsCalibration() {
  core::CameraCalibration view;
  view.name = "view";
  view.image_width_px = 320;
  view.image_height_px = 240;
  view.camera_matrix << 360.0, 0.0, 159.5, 0.0, 360.0, 119.5, 0.0, 0.0, 1.0;
  view.cam_from_world = core::CamFromWorldLookingAt(kOperatorsEye, kHand);
  return view;
}

core::CameraModel OperatorsView() { return core::CameraModel(OperatorsCalibration()); }

recon::ViewRays ViewThroughALens() {
  core::CameraCalibration view = OperatorsCalibration();
  view.distortion_coefficients = {-0.2, 0.05, 1e-3, -5e-4, 0.0};
  return recon::ViewRays(core::CameraModel(std::move(view)));
}

recon::ViewRays OrthographicView() {
  core::CameraCalibration view = OperatorsCalibration();
  view.camera_matrix.topLeftCorner<2, 2>() *= 0.4 / 360.0;  // 0.4 pixels per mm
  return recon::ViewRays(core::CameraModel(std::move(view)), recon::Projection::kOrthographic);
}

// A camera whose picture doesn't hold the whole hand, so that the unseen policy matters.
core::CameraModel CloseUp(const core::CameraModel& camera) {
  core::CameraCalibration close = camera.calibration();
  close.name = "close-up";
  close.camera_matrix.topLeftCorner<2, 2>() *= 3.0;
  return core::CameraModel(std::move(close));
}

Scene HandScene(core::Rig rig) {
  const std::vector<recon::SyntheticObject> objects = recon::DemoSceneAt(kHandOverTheTableS).objects;
  std::vector<core::SoftMask> masks = recon::TrueMasks(rig, objects);
  return {std::move(rig), std::move(masks), OperatorsView()};
}

SelfTestLine CompareSwept(const std::string& what, const Scene& scene,
                          const recon::PlaneSweepOptions& options, recon::gl::SweepPasses passes,
                          recon::gl::PlaneSweepGl* sweep) {
  const recon::SweepRays rays(scene.view);
  const recon::SweptView cpu = recon::SweepPlanes(scene.rig, scene.masks, scene.view, rays, options);
  const recon::SweptView gl = sweep->Sweep(scene.rig, scene.masks, scene.view, rays, options, passes);
  const recon::SweepComparison comparison = recon::CompareSweeps(
      scene.rig, scene.masks, scene.view, cpu.picture, gl.picture, options.undistortion_grid);
  return {what, cpu.picture.hit_pixels, comparison.differing_pixels, comparison.unexplained_pixels};
}

// The demo's PMT box where the hand is: all its triangles in viewports.
SelfTestLine CompareSampled(const Scene& scene, recon::gl::TriangleViewportsGl* viewports) {
  const recon::CoverageHull hull(scene.rig, scene.masks);
  const core::TriangleMesh part = PmtBox();
  const core::RigidTransform world_from_part{Eigen::Matrix3d::Identity(), kHand};
  const recon::SampledContacts cpu = recon::SampleTriangles(hull, part, world_from_part);
  const recon::SampledContacts gl = viewports->Sample(hull, part, world_from_part);
  const recon::SampleComparison comparison = recon::CompareSamples(hull, cpu, gl);
  return {"collision, the paper's viewports", static_cast<std::int64_t>(cpu.contacts.size()),
          comparison.differing_samples, comparison.unexplained_samples};
}

SelfTestLine CompareExact(std::string what, const recon::VisualHull& hull, const recon::ViewRays& rays,
                          const MakeView& graphics) {
  const recon::HullView cpu = recon::ViewHull(hull, rays);
  const recon::ViewComparison comparison = recon::CompareViews(hull, rays, cpu, graphics(hull, rays, {}));
  return {std::move(what), cpu.hit_pixels, comparison.differing_pixels + comparison.differing_in_band,
          comparison.differing_pixels};
}

}  // namespace

bool SelfTestReport::Passed() const {
  return std::all_of(lines.begin(), lines.end(), [](const SelfTestLine& line) {
    return line.hit_pixels > 0 && line.unexplained_pixels == 0;
  });
}

SelfTestReport RunSelfTest() {
  recon::gl::PlaneSweepGl sweep;
  const Scene scene = HandScene(recon::FourCameraRig());
  SelfTestReport report{sweep.driver(), {}};
  for (const auto& [passes, name] :
       {std::pair{recon::gl::SweepPasses::kOneAPlane, "a draw a plane"},
        std::pair{recon::gl::SweepPasses::kOneAPlaneAndCamera, "the paper's passes"}}) {
    report.lines.push_back(CompareSwept(std::string("plane sweep, ") + name, scene, {}, passes, &sweep));
  }
  report.lines.push_back(CompareSwept("plane sweep, undistortion grid, the paper's passes", scene,
                                      {.undistortion_grid = kGrid},
                                      recon::gl::SweepPasses::kOneAPlaneAndCamera, &sweep));
  recon::gl::ExactViewGl card;
  for (SelfTestLine& line : TestExactViews([&](const recon::VisualHull&hull, const recon::ViewRays&rays,
                                               const recon::HullView&) { return card.ViewHull(hull, rays); }))
    report.lines.push_back(std::move(line));
  recon::gl::TriangleViewportsGl viewports;
  report.lines.push_back(CompareSampled(scene, &viewports));
  return report;
}

std::vector<SelfTestLine> TestExactViews(const MakeView& graphics) {
  core::Rig rig = recon::FourCameraRig();
  rig.cameras.push_back(CloseUp(rig.cameras[2]));
  Scene scene = HandScene(std::move(rig));
  const std::array<std::pair<const char*, recon::ViewRays>, 4> views = {
      {{"perspective", recon::ViewRays(scene.view)},
       {"through a lens", ViewThroughALens()},
       {"from a camera's place", recon::ViewRays(scene.rig.cameras.front())},
       {"orthographic", OrthographicView()}}};
  std::vector<SelfTestLine> lines;
  const recon::UndistortedPlanes planes = recon::MakeUndistortedPlanes(scene.rig);
  for (const auto& [unseen, policy] : {std::pair{core::UnseenPolicy::kOutside, "outside"},
                                       std::pair{core::UnseenPolicy::kAbstain, "abstain"}}) {
    scene.rig.unseen = unseen;
    const recon::VisualHull hull =
        recon::MakeVisualHull(std::make_shared<const core::Rig>(scene.rig), planes, scene.masks);
    for (const auto& [name, rays] : views)
      lines.push_back(CompareExact(fmt::format("exact view, {}, {}", name, policy), hull, rays, graphics));
  }
  return lines;
}

}  // namespace elbowroom::control
