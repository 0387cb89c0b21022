// Frames of the simulated trial to pictures: every look of the hull, with shadows.
#include "app/control/scene_composer.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "app/control/demo_parts.h"
#include "app/control/demo_trial.h"
#include "app/control/frame_pipeline.h"
#include "core/units.h"
#include "recon/exact_view/view_comparison.h"
#include "recon/gl/scene/scene_renderer.h"
#include "recon/hull/visual_hull.h"
#include "recon/images/png_file.h"
#include "tests/review/curtain.h"

namespace elbowroom::control {
namespace {

using recon::HullAppearance;

constexpr std::array kLooks{HullAppearance::kFlat, HullAppearance::kByNormal, HullAppearance::kOneCamera,
                            HullAppearance::kRigCameras};

// The demo's task, segmented from its pictures.
class DemoFrames {
 public:
  DemoFrames()
      : setup_(MakeDemoTrial(DemoPlay::kOnce)),
        pipeline_(setup_.source->rig(), setup_.layout, setup_.source->ReadBackgrounds({}, {}),
                  setup_.segmentation) {}

  [[nodiscard]] SharedFrameResult At(double time_s, double gap_mm = kGapNeededMm) {
    const auto frame = static_cast<core::FrameIndex>(std::lround(15.0 * time_s));
    return pipeline_.Process(setup_.source->Read(frame), std::vector<double>{gap_mm});
  }

 private:
  TrialSetup setup_;
  FramePipeline pipeline_;
};

DemoFrames& Demo() {
  static DemoFrames demo;
  return demo;
}

constexpr double kPipeIsHeldS = 4.4;
constexpr double kTongsAreInS = 11.0;

recon::SceneView TrialView(int width_px, int height_px, double azimuth_deg, double elevation_deg) {
  recon::OrbitCamera camera;
  camera.target_in_world = {50.0, 0.0, 210.0};
  camera.distance_mm = 1350.0;
  camera.azimuth_rad = core::RadiansFromDegrees(azimuth_deg);
  camera.elevation_rad = core::RadiansFromDegrees(elevation_deg);
  return recon::ViewFrom(camera, width_px, height_px);
}

recon::Image Draw(const recon::gl::Scene& scene) {
  static recon::gl::SceneRenderer renderer;
  return renderer.Render(scene);
}

// Two pictures of one height, side by side.
recon::Image Beside(const recon::Image& left, const recon::Image& right) {
  recon::Image both{left.width_px + right.width_px, left.height_px, {}};
  for (int y = 0; y < left.height_px; ++y) {
    for (const recon::Image* image : {&left, &right}) {
      const auto row = image->rgb.begin() + std::ptrdiff_t{3} * y * image->width_px;
      both.rgb.insert(both.rgb.end(), row, row + std::ptrdiff_t{3} * image->width_px);
    }
  }
  return both;
}

recon::Image Above(recon::Image top, const recon::Image& bottom) {
  top.rgb.insert(top.rgb.end(), bottom.rgb.begin(), bottom.rgb.end());
  top.height_px += bottom.height_px;
  return top;
}

TEST(SceneComposer, AFrameKeepsItsPicturesWithoutCopyingThem) {
  const TrialSetup setup = MakeDemoTrial(DemoPlay::kOnce);
  FramePipeline pipeline(setup.source->rig(), setup.layout, setup.source->ReadBackgrounds({}, {}),
                         setup.segmentation);
  recon::FrameSet frames = setup.source->Read(10);
  const std::uint8_t* bytes = frames.cameras[2].image_bgr.data;
  const SharedFrameResult result = pipeline.Process(std::move(frames), std::vector<double>{kGapNeededMm});
  ASSERT_NE(result->camera_frames, nullptr);
  EXPECT_EQ(result->camera_frames->cameras[2].image_bgr.data, bytes);
}

TEST(SceneComposer, KeepingChangesNothingAndSavesTheViewsOfOneFrame) {
  const SharedFrameResult frame = Demo().At(kPipeIsHeldS), other = Demo().At(kTongsAreInS);
  const recon::SceneView view = TrialView(240, 180, -62.0, 14.0), turned = TrialView(240, 180, -20.0, 30.0);
  SceneComposer kept;
  for (const HullAppearance look : {HullAppearance::kByNormal, HullAppearance::kRigCameras}) {
    (void)kept.Compose(*other, view);
    (void)kept.Compose(*frame, turned, {look});
    EXPECT_EQ(Draw(kept.Compose(*frame, view, {look})), Draw(SceneComposer().Compose(*frame, view, {look})));
  }
  EXPECT_NE(Draw(kept.Compose(*other, view)), Draw(kept.Compose(*frame, view)));
  SceneComposer counted;
  (void)counted.Compose(*frame, view);
  EXPECT_EQ(counted.extra_hull_views(), 1);  // the lamp's
  // Another frame of the same silhouettes costs no view, whatever else is new in it.
  FrameResult next = *frame;
  next.camera_frames = std::make_shared<const recon::FrameSet>(*frame->camera_frames);
  EXPECT_EQ(counted.Compose(next, view).hull, counted.Compose(*frame, view).hull);
  EXPECT_EQ(counted.hull_views(), 1);
  const auto from_lamp = counted.Compose(*frame, turned).hull_from_lamp;
  EXPECT_EQ(counted.hull_views(), 2);
  EXPECT_EQ(counted.Compose(*frame, view).hull_from_lamp, from_lamp);
  EXPECT_EQ(counted.hull_views(), 3);
  EXPECT_EQ(counted.extra_hull_views(), 1);
  (void)counted.Compose(*frame, view, {HullAppearance::kOneCamera});
  EXPECT_EQ(counted.extra_hull_views(), 2);
  (void)counted.Compose(*frame, view, {HullAppearance::kRigCameras});
  EXPECT_EQ(counted.extra_hull_views(), 5);  // the three cameras more
  (void)counted.Compose(*frame, turned, {HullAppearance::kRigCameras});
  EXPECT_EQ(counted.extra_hull_views(), 5);
}

TEST(SceneComposer, AHullThatWasForeseenIsNotSeenAgain) {
  const SharedFrameResult frame = Demo().At(kPipeIsHeldS), other = Demo().At(kTongsAreInS);
  const recon::SceneView view = TrialView(240, 180, -62.0, 14.0);
  SceneComposer composer;
  composer.Foresee(frame->hull, view);
  EXPECT_EQ(composer.hull_views(), 1);
  EXPECT_EQ(Draw(composer.Compose(*frame, view)), Draw(SceneComposer().Compose(*frame, view)));
  EXPECT_EQ(composer.hull_views(), 1);
  composer.Foresee(other->hull, view);  // whose frame never comes
  EXPECT_EQ(Draw(composer.Compose(*frame, view, {HullAppearance::kRigCameras})),
            Draw(SceneComposer().Compose(*frame, view, {HullAppearance::kRigCameras})));
}

TEST(SceneComposer, OneCameraIsTheViewersIfThereIsOne) {
  FrameResult worn = *Demo().At(kPipeIsHeldS);
  const recon::SceneView view = TrialView(240, 180, -62.0, 14.0);
  const auto head = std::make_shared<const core::CameraModel>(recon::CameraOf(view));
  recon::FrameSet frames = *worn.camera_frames;
  frames.viewer = recon::ViewerPicture{head, cv::Mat(180, 240, CV_8UC3, cv::Scalar(250, 10, 20))};
  worn.camera_frames = std::make_shared<const recon::FrameSet>(std::move(frames));
  SceneComposer composer;
  const recon::gl::Scene scene = composer.Compose(worn, view, {HullAppearance::kOneCamera});
  EXPECT_EQ(composer.extra_hull_views(), 2);  // the lamp's and the head's
  int trusted = 0;
  for (const recon::CameraColor& color : scene.hull_camera_color) {
    if (color[3] == 0) continue;
    EXPECT_EQ((recon::CameraColor{color[0], color[1], color[2], 0}), (recon::CameraColor{20, 10, 250, 0}));
    ++trusted;
  }
  EXPECT_GT(trusted, 500);
  (void)composer.Compose(worn, view, {HullAppearance::kRigCameras});
  EXPECT_EQ(composer.extra_hull_views(), 6);  // the demo's four cameras, and not the head's again
}

TEST(SceneComposer, WithoutPicturesTheHullIsShaded) {
  FrameResult bare = *Demo().At(kPipeIsHeldS);
  bare.camera_frames.reset();
  const recon::SceneView view = TrialView(240, 180, -62.0, 14.0);
  EXPECT_EQ(Draw(SceneComposer().Compose(bare, view, {HullAppearance::kRigCameras})),
            Draw(SceneComposer().Compose(bare, view, {HullAppearance::kByNormal})));
}

TEST(SceneComposer, TheHullIsTheSameWhicheverWayItIsMade) {
  const SharedFrameResult frame = Demo().At(kPipeIsHeldS);
  const recon::SceneView view = TrialView(240, 180, -62.0, 14.0);
  SceneComposer on_card(GraphicsCard("the driver at hand", false).open());
  const recon::gl::Scene cpu = SceneComposer().Compose(*frame, view), gl = on_card.Compose(*frame, view);
  const recon::ViewRays rays(recon::CameraOf(view));
  const auto depths = [](const recon::gl::Scene& scene) {
    recon::HullView hull;
    hull.depth_mm = scene.hull->depth_mm;
    return hull;
  };
  const recon::ViewComparison comparison = recon::CompareViews(*frame->hull, rays, depths(cpu), depths(gl));
  EXPECT_GT(comparison.hit_pixels, 1000);
  EXPECT_TRUE(comparison.Agree()) << comparison.differing_pixels;
  EXPECT_EQ(gl.parts.size(), cpu.parts.size());
  EXPECT_EQ(gl.hull_from_lamp->depth_mm, cpu.hull_from_lamp->depth_mm);  // the lamp's is the processor's
}

// With ELBOWROOM_PICTURE_DIR set it leaves the pictures there to be looked at.
TEST(SceneComposer, EveryLookIsAPictureOfItsOwn) {
  SceneComposer composer;
  const SharedFrameResult frame = Demo().At(kTongsAreInS);
  const recon::SceneView view = TrialView(640, 480, -35.0, 22.0);
  std::vector<recon::Image> pictures;
  for (const HullAppearance look : kLooks) {
    pictures.push_back(Draw(composer.Compose(*frame, view, {look})));
    for (std::size_t i = 0; i + 1 < pictures.size(); ++i) EXPECT_NE(pictures[i], pictures.back());
  }
  if (const char* folder = std::getenv("ELBOWROOM_PICTURE_DIR")) {
    const std::string path = folder;
    recon::WritePng(Above(Beside(pictures[0], pictures[1]), Beside(pictures[2], pictures[3])),
                    path + "/hull_appearance.png");
    recon::WritePng(Draw(composer.Compose(*frame, TrialView(960, 720, -40.0, 35.0))), path + "/shadows.png");
  }
}

// The curtain across x, and a faucet before it, over the demo's table.
core::Layout CurtainAndFaucet() {
  core::Part curtain = review::Curtain();
  curtain.world_from_part = core::FromPositionAndRollPitchYaw({100.0, 0.0, 440.0}, {0.0, 0.0, 90.0});
  core::Stream faucet;
  faucet.name = "faucet";
  faucet.position_mm = {230.0, 15.0, 480.0};
  core::Layout layout;
  layout.parts = {curtain};
  layout.streams = {faucet};
  return layout;
}

// With ELBOWROOM_PICTURE_DIR set it leaves the picture there to be looked at.
TEST(SceneComposer, ACurtainAndAStreamAreDrawnAsTheyGiveWay) {
  const TrialSetup setup = MakeDemoTrial(DemoPlay::kOnce);
  FramePipeline pipeline(setup.source->rig(), CurtainAndFaucet(), setup.source->ReadBackgrounds({}, {}),
                         setup.segmentation);
  SharedFrameResult frame;
  for (core::FrameIndex i = 0; i <= static_cast<core::FrameIndex>(15.0 * kPipeIsHeldS); ++i)
    frame = pipeline.Process(setup.source->Read(i), {});
  ASSERT_NE(frame->response, nullptr);
  const core::SharedMesh& curtain = frame->response->meshes_in_world[0];
  double pushed_mm = 0.0;
  for (const Eigen::Vector3d& x : curtain->vertices_mm) pushed_mm = std::max(pushed_mm, 100.0 - x.x());
  EXPECT_GT(pushed_mm, 60.0);  // the hand holds its pipe over x = 0, coming from x > 0
  EXPECT_GT(frame->response->streams[0].particles.size(), 20U);
  const recon::SceneView view = TrialView(960, 720, -35.0, 22.0);
  FrameResult bare = *frame;
  bare.response.reset();
  const recon::Image picture = Draw(SceneComposer().Compose(*frame, view));
  EXPECT_NE(picture, Draw(SceneComposer().Compose(bare, view)));
  if (const char* folder = std::getenv("ELBOWROOM_PICTURE_DIR")) {
    recon::WritePng(Beside(picture, Draw(SceneComposer().Compose(*frame, TrialView(960, 720, -125.0, 22.0)))),
                    std::string(folder) + "/gives_way.png");
  }
}

}  // namespace
}  // namespace elbowroom::control
