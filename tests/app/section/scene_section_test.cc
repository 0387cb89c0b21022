// Parts and hull cut open in the 3-D view: nothing beyond a plane is drawn, and the cut has faces.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include "app/control/demo_trial.h"
#include "app/control/frame_pipeline.h"
#include "app/control/scene_composer.h"
#include "recon/appearance/orbit_camera.h"
#include "recon/gl/scene/scene_renderer.h"
#include "recon/hull/visual_hull.h"

namespace elbowroom::control {
namespace {

using Eigen::Vector3d;

// The demo's hand holds its pipe.
SharedFrameResult Frame() {
  TrialSetup setup = MakeDemoTrial(DemoPlay::kOnce);
  FramePipeline pipeline(setup.source->rig(), setup.layout, setup.source->ReadBackgrounds({}, {}),
                         setup.segmentation);
  return pipeline.Process(setup.source->Read(66), std::vector<double>{240.0});
}

recon::SceneView FrontView(bool is_parallel) {
  recon::OrbitCamera camera;
  camera.target_in_world = {50.0, 0.0, 210.0};
  camera.distance_mm = 1400.0;
  camera.is_parallel = is_parallel;
  camera = recon::Along(camera, recon::StandardView::kFront);
  camera.elevation_rad = 0.3;
  return recon::ViewFrom(camera, 320, 240);
}

struct CutPixels {
  int seen = 0;
  int beyond = 0;  // of them, on the side that was taken away
  int on_plane = 0;
};

CutPixels Count(const recon::gl::Scene& scene, const CutPlane& plane, Eigen::Index axis, double slack_mm) {
  static recon::gl::SceneRenderer renderer;
  const recon::gl::DepthImage depth = renderer.RenderDepth(scene);
  const core::RigidTransform world_from_cam = scene.view.cam_from_world.Inverse();
  CutPixels count;
  for (int y = 0; y < depth.height_px; ++y) {
    for (int x = 0; x < depth.width_px; ++x) {
      const double depth_mm = depth.depth_mm[static_cast<std::size_t>(y * depth.width_px + x)];
      if (depth_mm <= 0.0) continue;
      const Vector3d at = world_from_cam * (scene.view.RayInCam({x, y}) * depth_mm);
      const double off_mm = (plane.keeps_above ? 1.0 : -1.0) * (at[axis] - plane.at_mm);
      ++count.seen;
      count.beyond += off_mm < -slack_mm ? 1 : 0;
      count.on_plane += std::abs(off_mm) <= slack_mm ? 1 : 0;
    }
  }
  return count;
}

TEST(SceneSection, ShowsNothingBeyondThePlaneAndClosesTheCut) {
  const SharedFrameResult frame = Frame();
  const CutPlane plane{5.0, true};  // what is behind stays
  SceneLook look;
  look.cut.planes[1] = plane;
  for (const bool is_parallel : {false, true}) {
    // The depth buffer's rounding; a parallel view's eye is far away.
    const double slack_mm = is_parallel ? 3.0 : 0.6;
    SceneComposer composer;
    recon::gl::Scene scene = composer.Compose(*frame, FrontView(is_parallel), look);
    const CutPixels all = Count(scene, plane, 1, slack_mm);
    EXPECT_GT(all.seen, 3000);
    EXPECT_EQ(all.beyond, 0);
    EXPECT_GT(all.on_plane, 1000);
    recon::gl::Scene hull_alone = scene;
    hull_alone.parts.clear();
    const CutPixels hull = Count(hull_alone, plane, 1, slack_mm);
    EXPECT_GT(hull.on_plane, 20);  // the pipe and the hand, cut through
    EXPECT_EQ(hull.beyond, 0);
    scene.hull = nullptr;
    EXPECT_GT(Count(scene, plane, 1, slack_mm).on_plane, 500);
  }
}

TEST(SceneSection, IsMadeOnceAndForgottenWithTheCut) {
  const SharedFrameResult frame = Frame();
  SceneLook look;
  SceneComposer composer;
  const recon::SceneView view = FrontView(false);
  const std::size_t whole_parts = composer.Compose(*frame, view, look).parts.size();
  look.cut.planes[0] = CutPlane{20.0, false};
  const recon::gl::Scene cut = composer.Compose(*frame, view, look),
                         again = composer.Compose(*frame, view, look);
  EXPECT_GT(cut.parts.size(), whole_parts);  // faces of the cut are parts of their own
  ASSERT_EQ(cut.parts.size(), again.parts.size());
  for (std::size_t i = 0; i < cut.parts.size(); ++i) EXPECT_EQ(cut.parts[i].mesh, again.parts[i].mesh);
  EXPECT_EQ(cut.hull, again.hull);
  EXPECT_EQ(composer.Compose(*frame, view).parts.size(), whole_parts);
  // Everything cut away: an empty picture, not an error.
  look.cut.planes[0] = CutPlane{-1e4, false};
  const recon::gl::Scene nothing = composer.Compose(*frame, view, look);
  EXPECT_TRUE(nothing.parts.empty());
  EXPECT_EQ(nothing.hull->hit_pixels, 0);
}

}  // namespace
}  // namespace elbowroom::control
