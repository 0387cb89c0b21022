#include "recon/gl/scene/scene_renderer.h"

#include <epoxy/gl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <thread>
#include <utility>
#include <vector>

#include "core/error.h"
#include "recon/appearance/orbit_camera.h"
#include "recon/images/png_file.h"
#include "tests/recon/gl/sample_scene.h"
#include "tests/support/resident_memory.h"

namespace elbowroom::recon::gl {
namespace {

using Rgb = std::array<int, 3>;

Rgb PixelAt(const Image& image, int x, int y) {
  const std::size_t first = 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width_px) +
                                 static_cast<std::size_t>(x));
  return {image.rgb[first], image.rgb[first + 1], image.rgb[first + 2]};
}

// Parts in these tests are blue, the hull is green, contacts are red, the background is grey: which of them a
// pixel shows is its strongest channel, by a margin that shading keeps.
constexpr int kMargin = 25;
enum class Owner { kBackground, kContact, kHull, kPart };
Owner OwnerOf(const Rgb& pixel) {
  const auto strongest = std::max_element(pixel.begin(), pixel.end());
  const Rgb others{pixel[1] + pixel[2], pixel[0] + pixel[2], pixel[0] + pixel[1]};
  const auto channel = static_cast<std::size_t>(strongest - pixel.begin());
  if (2 * *strongest - others[channel] < 2 * kMargin) return Owner::kBackground;
  return std::array{Owner::kContact, Owner::kHull, Owner::kPart}[channel];
}

Scene GreyScene() {
  Scene scene;
  OrbitCamera camera;
  camera.distance_mm = 900.0;
  scene.view = ViewFrom(camera, 320, 240);
  scene.background_top = scene.background_bottom = {0.8F, 0.8F, 0.8F};
  scene.hull_color = {0.1F, 0.8F, 0.1F};
  return scene;
}

ScenePart BluePart(core::SharedMesh mesh) { return {std::move(mesh), {}, {0.1F, 0.1F, 0.8F}}; }

// Objects of one kind that are alive in the current context; drivers number names from 1.
template <typename IsAlive>
int CountAlive(IsAlive is_alive) {
  int count = 0;
  for (GLuint name = 1; name < 20'000; ++name) count += is_alive(name) == GL_TRUE ? 1 : 0;
  return count;
}
std::array<int, 6> CountGlObjects() {
  return {CountAlive([](GLuint name) { return glIsBuffer(name); }),
          CountAlive([](GLuint name) { return glIsVertexArray(name); }),
          CountAlive([](GLuint name) { return glIsTexture(name); }),
          CountAlive([](GLuint name) { return glIsRenderbuffer(name); }),
          CountAlive([](GLuint name) { return glIsFramebuffer(name); }),
          CountAlive([](GLuint name) { return glIsProgram(name); })};
}

TEST(SceneRenderer, EmptySceneIsItsBackgroundFromTopToBottom) {
  SceneRenderer renderer;
  Scene scene;
  scene.background_top = {1, 0, 0};
  scene.background_bottom = {0, 0, 1};
  const Image image = renderer.Render(scene);
  ASSERT_EQ(image.rgb.size(), 640U * 480U * 3U);
  const Rgb top = PixelAt(image, 320, 0);
  const Rgb bottom = PixelAt(image, 320, 479);
  EXPECT_GE(top[0], 254);
  EXPECT_LE(top[2], 1);
  EXPECT_LE(bottom[0], 1);
  EXPECT_GE(bottom[2], 254);
}

class SceneOfEachSmoothness : public ::testing::TestWithParam<Smoothness> {};
INSTANTIATE_TEST_SUITE_P(SceneRenderer, SceneOfEachSmoothness,
                         ::testing::Values(Smoothness::kOneSample, Smoothness::kFourSamples));

TEST_P(SceneOfEachSmoothness, NearerOfHullAndPartOwnsThePixel) {
  SceneRenderer renderer;
  Scene scene = GreyScene();
  scene.smoothness = GetParam();
  const Eigen::AlignedBox3d box(Eigen::Vector3d(-60, -60, -60), Eigen::Vector3d(60, 60, 60));
  scene.parts.push_back(BluePart(BoxMesh(box.min(), box.max())));
  const Eigen::Vector3d to_eye = scene.view.EyeInWorld().normalized();
  for (const double offset_mm : {250.0, -250.0, 48.0}) {
    const std::vector<Capsule> ball{{offset_mm * to_eye, offset_mm * to_eye + Eigen::Vector3d(5, 0, 0), 40}};
    scene.hull = CastLayer(scene.view, 320, 240, ball);
    const Image image = renderer.Render(scene);
    int checked = 0;
    for (int y = 0; y < 240; ++y) {
      for (int x = 0; x < 320; ++x) {
        const auto hull = CastRay(scene.view, {x, y}, ball);
        const auto box_mm = BoxDepth(scene.view, {x, y}, box);
        if (!hull || !box_mm || std::abs(hull->depth_mm - *box_mm) < 8.0)
          continue;  // edge lines stand nearer
        const Owner owner = OwnerOf(PixelAt(image, x, y));
        if (hull->depth_mm < *box_mm) {
          EXPECT_NE(owner, Owner::kPart) << x << ", " << y;
        } else {
          EXPECT_NE(owner, Owner::kHull) << x << ", " << y;
        }
        ++checked;
      }
    }
    EXPECT_GT(checked, 500) << offset_mm;
    const Owner middle = OwnerOf(PixelAt(image, 160, 120));
    if (std::abs(offset_mm) > 100.0) {
      EXPECT_EQ(middle, offset_mm > 0.0 ? Owner::kHull : Owner::kPart) << offset_mm;
    }
  }
}

TEST_P(SceneOfEachSmoothness, HullIsAsLargeAsItsLayer) {
  SceneRenderer renderer;
  Scene scene = GreyScene();
  scene.smoothness = GetParam();
  const std::vector<Capsule> ball{{{0, 0, 0}, {5, 0, 0}, 100}};
  scene.hull = CastLayer(scene.view, 320, 240, ball);
  const Image image = renderer.Render(scene);
  int hits = 0, owned = 0;
  for (int y = 0; y < 240; ++y) {
    for (int x = 0; x < 320; ++x) {
      hits += CastRay(scene.view, {x, y}, ball) ? 1 : 0;
      owned += OwnerOf(PixelAt(image, x, y)) == Owner::kHull ? 1 : 0;
    }
  }
  constexpr double kMostOffShare = 0.01;  // a rim that is a third of a pixel too wide would be 0.02
  EXPECT_NEAR(owned, hits, kMostOffShare * hits);
}

TEST(SceneRenderer, OneSampleShowsTheSamePictureButForItsEdges) {
  SceneRenderer renderer;
  Scene scene = TrialScene(640, 480);
  const Image smooth = renderer.Render(scene);
  scene.smoothness = Smoothness::kOneSample;
  const Image jagged = renderer.Render(scene);
  scene.smoothness = Smoothness::kFourSamples;
  EXPECT_EQ(renderer.Render(scene), smooth);
  EXPECT_NE(jagged, smooth);
  int off = 0;
  for (std::size_t i = 0; i < smooth.rgb.size(); ++i)
    off += std::abs(int{smooth.rgb[i]} - int{jagged.rgb[i]}) > 8;
  constexpr double kMostEdges = 0.05;  // of the picture's values: outlines and the grid's lines
  EXPECT_LT(off, kMostEdges * static_cast<double>(smooth.rgb.size()));
}

TEST(SceneRenderer, PicturesThatBecomeFinerTakeNoMemory) {
  constexpr int kWidthPx = 1280, kHeightPx = 800;
  constexpr double kMostMb = 6.0;  // the picture itself has 3, a still layer of that size 29
  SceneRenderer renderer;
  if (!renderer.is_software()) GTEST_SKIP() << "the graphics card's memory isn't the process's";
  const auto draw = [&](double share, Smoothness smoothness) {
    constexpr int kLayerWidthPx = 32, kLayerHeightPx = 20;  // the test's own layers take no memory
    Scene scene = TrialScene(kLayerWidthPx, kLayerHeightPx);
    scene.view.width_px = static_cast<int>(share * kWidthPx);
    scene.view.height_px = static_cast<int>(share * kHeightPx);
    scene.view.focal_px *= share * kWidthPx / kLayerWidthPx;
    scene.largest_px = {kWidthPx, kHeightPx};
    scene.smoothness = smoothness;
    for (int i = 0; i < 3; ++i) (void)renderer.Render(scene);
    return 1e-6 * static_cast<double>(test_support::ResidentBytes(::getpid()));
  };
  draw(1.0, Smoothness::kFourSamples);
  const double coarse_mb = draw(0.5, Smoothness::kOneSample);
  for (const double share : {0.65, 0.8, 1.0})
    EXPECT_LE(draw(share, Smoothness::kOneSample), coarse_mb + kMostMb) << share;
  EXPECT_GE(draw(0.5, Smoothness::kOneSample), coarse_mb - kMostMb);
}

TEST(SceneRenderer, LayerWithoutNormalsIsShadedFromItsDepths) {
  SceneRenderer renderer;
  Scene scene = GreyScene();
  const std::vector<Capsule> ball{{{0, 0, 0}, {5, 0, 0}, 100}};
  scene.hull = CastLayer(scene.view, 320, 240, ball);
  const Image exact = renderer.Render(scene);
  HullView bare = *scene.hull;
  bare.normal_in_world.clear();
  scene.hull = std::make_shared<const HullView>(bare);
  const Image derived = renderer.Render(scene);
  double sum = 0.0;
  for (std::size_t i = 0; i < exact.rgb.size(); ++i) sum += std::abs(int{exact.rgb[i]} - int{derived.rgb[i]});
  EXPECT_NE(exact, derived);
  EXPECT_LT(sum / static_cast<double>(exact.rgb.size()), 0.5);  // grey levels on average: the same shading
}

TEST(SceneRenderer, CameraColoursShowOnTheirOwnPixelsWhereTheyAreTrusted) {
  constexpr int kSquarePx = 10;
  SceneRenderer renderer;
  Scene scene = GreyScene();
  const std::vector<Capsule> ball{{{0, 0, 0}, {5, 0, 0}, 100}};
  scene.hull = CastLayer(scene.view, 320, 240, ball);
  const Image shaded = renderer.Render(scene);
  const auto is_light = [](int x, int y) { return (x / kSquarePx + y / kSquarePx) % 2 == 0; };
  for (int y = 0; y < 240; ++y) {
    for (int x = 0; x < 320; ++x) {
      const std::uint8_t trust = x < 160 ? 255 : 0;
      scene.hull_camera_color.push_back(is_light(x, y) ? CameraColor{220, 40, 200, trust}
                                                       : CameraColor{60, 20, 100, trust});
    }
  }
  scene.hull_appearance = HullAppearance::kRigCameras;
  const Image image = renderer.Render(scene);
  int checked = 0;
  for (int y = 2; y < 238; ++y) {
    for (int x = 2; x < 318; ++x) {
      const bool is_inside =
          CastRay(scene.view, {x - 2, y - 2}, ball) && CastRay(scene.view, {x + 2, y + 2}, ball) &&
          CastRay(scene.view, {x - 2, y + 2}, ball) && CastRay(scene.view, {x + 2, y - 2}, ball);
      if (!is_inside || x == 159 || x == 160) continue;
      const Rgb pixel = PixelAt(image, x, y);
      if (x >= 160) {
        EXPECT_EQ(pixel, PixelAt(shaded, x, y)) << x << ", " << y;
        continue;
      }
      // Half a pixel of shift would mix a square's outermost pixels half and half.
      EXPECT_EQ(pixel[0] > 140, is_light(x, y)) << x << ", " << y;
      ++checked;
    }
  }
  EXPECT_GT(checked, 2000);
  scene.hull_appearance = HullAppearance::kByNormal;
  EXPECT_EQ(renderer.Render(scene), shaded);
  scene.hull_appearance = HullAppearance::kFlat;
  const Image flat = renderer.Render(scene);
  EXPECT_EQ(PixelAt(flat, 160, 120), PixelAt(flat, 140, 100));
}

TEST(SceneRenderer, SmallerLayerCoversTheSamePicture) {
  SceneRenderer renderer;
  Scene scene = GreyScene();
  const std::vector<Capsule> ball{{{0, 0, 0}, {5, 0, 0}, 100}};
  scene.hull = CastLayer(scene.view, 160, 120, ball);
  const Image image = renderer.Render(scene);
  int differing = 0;
  for (int y = 0; y < 240; ++y) {
    for (int x = 0; x < 320; ++x) {
      const bool drawn = OwnerOf(PixelAt(image, x, y)) == Owner::kHull;
      differing += drawn != CastRay(scene.view, {x, y}, ball).has_value() ? 1 : 0;
    }
  }
  EXPECT_LT(differing, 600);  // one pixel along a rim of 600
}

TEST(SceneRenderer, ContactMarkSitsOnItsPixel) {
  SceneRenderer renderer;
  Scene scene = GreyScene();
  scene.contact_points_in_world = {{40, -30, 25}};
  const Eigen::Vector2d expected_px = scene.view.Project(scene.contact_points_in_world.front()).value();
  const Image image = renderer.Render(scene);
  Eigen::Vector2d sum_px = Eigen::Vector2d::Zero();
  int marked = 0;
  for (int y = 0; y < 240; ++y) {
    for (int x = 0; x < 320; ++x) {
      if (PixelAt(image, x, y) == PixelAt(image, 0, 0)) continue;
      sum_px += Eigen::Vector2d(x, y);
      ++marked;
    }
  }
  EXPECT_NEAR(marked, 64.0, 20.0);                          // a disc of 8 px and its soft rim
  EXPECT_LT((sum_px / marked - expected_px).norm(), 0.25);  // each pixel counts whole, also at the soft rim
  EXPECT_EQ(OwnerOf(PixelAt(image, static_cast<int>(std::lround(expected_px.x())),
                            static_cast<int>(std::lround(expected_px.y())))),
            Owner::kContact);
}

TEST(SceneRenderer, ContactMarksShowThroughFaintlyAndClearlyJustUnderTheSkin) {
  SceneRenderer renderer;
  Scene scene = GreyScene();
  scene.background_top = scene.background_bottom = {0.1F, 0.1F, 0.1F};
  const Eigen::Vector3d to_eye = scene.view.EyeInWorld().normalized();
  scene.hull = CastLayer(scene.view, 320, 240, {{{0, 0, 0}, {1, 0, 0}, 100}});
  const auto red_at = [&](double radius_mm) {
    scene.contact_points_in_world = {radius_mm * to_eye};
    return PixelAt(renderer.Render(scene), 160, 120);
  };
  scene.contact_points_in_world.clear();
  const Rgb bare = PixelAt(renderer.Render(scene), 160, 120);
  const Rgb shown = red_at(92.0);
  const Rgb hidden = red_at(30.0);
  EXPECT_EQ(OwnerOf(shown), Owner::kContact);
  EXPECT_GT(hidden[0], bare[0] + kMargin);
  EXPECT_GT(hidden[1], shown[1] + kMargin);  // the green hull before it is seen still
}

TEST(SceneRenderer, PartInContactTurnsWarm) {
  SceneRenderer renderer;
  Scene scene = GreyScene();
  scene.parts.push_back(BluePart(BoxMesh({-60, -60, -60}, {60, 60, 60})));
  const Rgb cold = PixelAt(renderer.Render(scene), 170, 125);
  scene.parts.front().in_contact = true;
  const Rgb warm = PixelAt(renderer.Render(scene), 170, 125);
  EXPECT_GT(cold[2], cold[0] + kMargin);
  EXPECT_GT(warm[0], warm[2] + kMargin);
}

TEST(SceneRenderer, TransparentPartLetsTheHullThrough) {
  SceneRenderer renderer;
  Scene scene = GreyScene();
  scene.parts.push_back(BluePart(BoxMesh({-60, -60, -60}, {60, 60, 60})));
  scene.hull = CastLayer(scene.view, 320, 240, {{{0, 0, 0}, {1, 0, 0}, 40}});
  const Rgb opaque = PixelAt(renderer.Render(scene), 163, 122);
  scene.parts.front().opacity = 0.3F;
  const Rgb glassy = PixelAt(renderer.Render(scene), 163, 122);
  scene.parts.front().opacity = 0.0F;
  const Rgb alone = PixelAt(renderer.Render(scene), 163, 122);
  EXPECT_LT(opaque[1], glassy[1] - kMargin);
  EXPECT_LT(glassy[1], alone[1] - kMargin);
  EXPECT_LT(alone[2], glassy[2] - kMargin / 2);
}

TEST(SceneRenderer, OrderOfTransparentPartsDoesNotMatter) {
  SceneRenderer renderer;
  Scene scene = GreyScene();
  const Eigen::Vector3d to_eye = scene.view.EyeInWorld().normalized();
  for (const double offset_mm : {100.0, -100.0}) {
    ScenePart part = BluePart(BoxMesh({-50, -50, -50}, {50, 50, 50}));
    part.color = offset_mm > 0 ? Eigen::Vector3f(0.8F, 0.1F, 0.1F) : part.color;
    part.world_from_part.translation_mm = offset_mm * to_eye;
    part.opacity = 0.5F;
    scene.parts.push_back(part);
  }
  const Image one_way = renderer.Render(scene);
  std::swap(scene.parts[0], scene.parts[1]);
  EXPECT_EQ(one_way, renderer.Render(scene));
}

TEST(SceneRenderer, SharedMeshIsUploadedOnceAndForgottenWithItsLastOwner) {
  SceneRenderer renderer;
  Scene scene = GreyScene();
  const core::SharedMesh mesh = BoxMesh({-10, -10, -10}, {10, 10, 10});
  scene.parts = {BluePart(mesh), BluePart(mesh), BluePart(BoxMesh({-5, -5, 20}, {5, 5, 30}))};
  for (int i = 0; i < 3; ++i) (void)renderer.Render(scene);
  scene.parts.front().world_from_part.translation_mm.x() += 5.0;
  (void)renderer.RenderDepth(scene);
  EXPECT_EQ(renderer.mesh_uploads(), 2);
  EXPECT_EQ(renderer.cached_meshes(), 2U);
  scene.parts.pop_back();
  (void)renderer.Render(scene);
  EXPECT_EQ(renderer.cached_meshes(), 1U);
  EXPECT_EQ(renderer.mesh_uploads(), 2);
}

TEST(SceneRenderer, MeshesWithOneOwnerAreToldApart) {
  SceneRenderer renderer;
  Scene scene = GreyScene();
  const auto both = std::make_shared<const std::array<core::TriangleMesh, 2>>(
      std::array{*BoxMesh({-60, -60, -60}, {0, 60, 60}), *BoxMesh({0, -60, -60}, {60, 60, 60})});
  scene.parts = {BluePart({both, &(*both)[0]})};
  const Image first = renderer.Render(scene);
  scene.parts = {BluePart({both, &(*both)[1]})};
  EXPECT_NE(first, renderer.Render(scene));
  EXPECT_EQ(renderer.cached_meshes(), 2U);
}

TEST(SceneRenderer, MeshThatCannotBeDrawnIsAnErrorAndTheNextPictureIsRight) {
  SceneRenderer renderer;
  Scene scene = TrialScene(160, 120);
  const Image before = renderer.Render(scene);
  Scene broken = scene;
  broken.parts.push_back(
      {std::make_shared<const core::TriangleMesh>(core::TriangleMesh{{{0, 0, 0}}, {{0, 1, 2}}}), {}});
  EXPECT_THROW((void)renderer.Render(broken), core::Error);
  EXPECT_EQ(before, renderer.Render(scene));
}

TEST(SceneRenderer, WorksInAWorkerThreadAndOnlyThere) {
  Image in_worker;
  bool refused = false;
  SceneRenderer here;
  const Scene scene = TrialScene(160, 120);
  std::thread worker([&] {
    SceneRenderer there;
    in_worker = there.Render(scene);
    try {
      (void)here.Render(scene);
    } catch (const core::PreconditionError&) {
      refused = true;
    }
  });
  worker.join();
  EXPECT_TRUE(refused);
  EXPECT_EQ(in_worker, here.Render(scene));
}

TEST(SceneRenderer, TwoInOneThreadDoNotDisturbEachOther) {
  const Scene large = TrialScene(160, 120);
  const Scene small = TrialScene(96, 64);
  SceneRenderer first;
  const Image large_alone = first.Render(large);
  Image small_alone;
  {
    SceneRenderer second;
    small_alone = second.Render(small);
    EXPECT_EQ(large_alone, first.Render(large));
    EXPECT_EQ(small_alone, second.Render(small));
  }
  EXPECT_EQ(small_alone, first.Render(small));
  SceneRenderer moved = std::move(first);
  EXPECT_EQ(large_alone, moved.Render(large));
  first = SceneRenderer();
  EXPECT_EQ(large_alone, first.Render(large));
}

TEST(SceneRenderer, ThousandPicturesLeaveNothingBehind) {
  SceneRenderer renderer;
  Scene scene = TrialScene(64, 48);
  (void)renderer.Render(scene);
  const std::array<int, 6> before = CountGlObjects();
  EXPECT_GT(before[0], 5);  // the counting sees something
  for (int i = 0; i < 1000; ++i) {
    scene.parts[0].mesh = BoxMesh({-150, -130, 0}, {150, 130, 100.0 + 0.01 * i});
    if (i % 100 == 50) (void)renderer.RenderDepth(scene);
    (void)renderer.Render(scene);
  }
  EXPECT_EQ(before, CountGlObjects());
  EXPECT_EQ(renderer.mesh_uploads(), 1005);
  EXPECT_EQ(renderer.cached_meshes(), 5U);
}

TEST(SceneRenderer, SceneThatIsNotValidIsABug) {
  SceneRenderer renderer;
  Scene scene;
  scene.parts.push_back({});
  EXPECT_THROW((void)renderer.Render(scene), core::PreconditionError);
  scene.parts.clear();
  HullView hull;
  hull.width_px = hull.height_px = 2;
  hull.depth_mm = {1, 2, 3};
  scene.hull = std::make_shared<const HullView>(hull);
  EXPECT_THROW((void)renderer.Render(scene), core::PreconditionError);
  scene.hull.reset();
  scene.view.near_mm = 0.0;
  EXPECT_THROW((void)renderer.Render(scene), core::PreconditionError);
}

// Prints the time a picture takes; with ELBOWROOM_PICTURE_DIR set it leaves the pictures there to be looked
// at.
TEST(SceneRenderer, DrawsATrialAndTellsTheTime) {
  SceneRenderer renderer;
  const Scene timed = TrialScene(640, 480);
  (void)renderer.Render(timed);
  std::vector<double> times_ms;
  for (int i = 0; i < 15; ++i) {
    const auto start = std::chrono::steady_clock::now();
    (void)renderer.Render(timed);
    times_ms.push_back(
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
  }
  std::nth_element(times_ms.begin(), times_ms.begin() + 7, times_ms.end());
  std::cout << "640 x 480 on " << renderer.driver() << ": " << times_ms[7] << " ms (median of 15)\n";
  RecordProperty("median_ms", std::to_string(times_ms[7]));
  Scene scene = TrialScene(960, 720);
  const Image solid = renderer.Render(scene);
  scene.parts[3].opacity = 0.35F;
  const Image glassy = renderer.Render(scene);
  EXPECT_NE(solid, glassy);
  if (const char* folder = std::getenv("ELBOWROOM_PICTURE_DIR")) {
    WritePng(solid, std::string(folder) + "/solid.png");
    WritePng(glassy, std::string(folder) + "/glassy.png");
    scene.hull = CastLayer(scene.view, 320, 240, Hand({55, 0, 225}));
    WritePng(renderer.Render(scene), std::string(folder) + "/coarse_hull.png");
  }
}

}  // namespace
}  // namespace elbowroom::recon::gl
