// What stays in a picture is drawn once, and the pictures are those that drawing all of it gives.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <random>
#include <vector>

#include "recon/gl/scene/scene_renderer.h"
#include "recon/gl/scene/shadow_reach.h"
#include "tests/recon/gl/sample_scene.h"
#include "tests/support/soak.h"

namespace elbowroom::recon::gl {
namespace {

using Eigen::Vector3d;

constexpr int kStillWidthPx = 320, kStillHeightPx = 240;

Scene OneSampleScene() {
  Scene scene = TrialScene(kStillWidthPx, kStillHeightPx);
  scene.smoothness = Smoothness::kOneSample;
  return scene;
}

void PutHandAt(Scene& scene, const Vector3d& palm_in_world) {
  constexpr int kLampPx = 256;
  const std::vector<Capsule> hand = Hand(palm_in_world);
  scene.hull = CastLayer(scene.view, kStillWidthPx, kStillHeightPx, hand);
  scene.hull_from_lamp = CastLayer(scene.lamp.ShadowView(kLampPx), kLampPx, kLampPx, hand);
}

struct Difference {
  int largest = 0;  // of 255
  std::int64_t above_two = 0;
};

Difference DifferenceOf(const Image& a, const Image& b) {
  Difference difference;
  for (std::size_t i = 0; i < a.rgb.size(); ++i) {
    const int by = std::abs(int{a.rgb[i]} - int{b.rgb[i]});
    difference.largest = std::max(difference.largest, by);
    difference.above_two += by > 2 ? 1 : 0;
  }
  return difference;
}

class KeptPictures : public testing::Test {
 protected:
  SceneRenderer kept_, anew_{PartDetail::kWhole, StillThings::kDrawnAnew};

  // Rounding alone: two colours of eight bits are mixed.
  void ExpectSame(const Scene& scene) {
    const Difference difference = DifferenceOf(kept_.Render(scene), anew_.Render(scene));
    EXPECT_LE(difference.largest, 2) << difference.above_two << " channels";
  }
};

TEST_F(KeptPictures, OfAMovingHandAreThoseDrawnAnew) {
  Scene scene = OneSampleScene();
  std::mt19937 random(11);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  for (int i = 0; i < 12; ++i) {
    PutHandAt(scene, {-150 + 300 * share(random), -120 + 240 * share(random), 20 + 400 * share(random)});
    ExpectSame(scene);
  }
  EXPECT_EQ(kept_.still_count(), (StillCount{1, 0, 10}));  // the first picture is drawn without
  EXPECT_EQ(anew_.still_count(), StillCount{});
}

TEST_F(KeptPictures, HaveNoTraceOfAHullThatLeft) {
  Scene scene = OneSampleScene();
  scene.hull.reset();
  scene.hull_from_lamp.reset();
  (void)kept_.Render(scene);
  const Image empty = kept_.Render(scene);
  Scene with_hand = OneSampleScene();
  EXPECT_NE(kept_.Render(with_hand), empty);
  EXPECT_EQ(kept_.Render(scene), empty);
  ExpectSame(scene);
}

// The hull reaches below the table, before and behind lines and parts.
TEST_F(KeptPictures, OfAHullBelowTheTableAreThoseDrawnAnew) {
  Scene scene = OneSampleScene();
  for (const double z_mm : {-60.0, -10.0, 5.0}) {
    PutHandAt(scene, {200, -250, z_mm});
    ExpectSame(scene);
  }
}

TEST_F(KeptPictures, ShowSeeThroughPartsWithTheirShadows) {
  Scene scene = OneSampleScene();
  for (const float opacity : {0.3F, 0.0F, 1.0F}) {
    scene.parts[3].opacity = opacity;
    PutHandAt(scene, {0, 0, 330});
    ExpectSame(scene);
  }
}

TEST_F(KeptPictures, FollowEveryChangeOfWhatIsStill) {
  Scene scene = OneSampleScene();
  const auto expect_drawn_again = [&](const char* what, const auto& change) {
    SCOPED_TRACE(what);
    for (int i = 0; i < 2; ++i) (void)kept_.Render(scene);
    const StillCount before = kept_.still_count();
    change();
    PutHandAt(scene, {55, 0, 225});
    ExpectSame(scene);
    EXPECT_EQ(kept_.still_count(), before);  // what changed may change again
    for (int i = 0; i < 2; ++i) ExpectSame(scene);
    EXPECT_EQ(kept_.still_count(), (StillCount{before.drawn + 1, before.renewed, before.kept + 1}));
  };
  expect_drawn_again("eye", [&] { scene.view.cam_from_world.translation_mm.x() += 15; });
  expect_drawn_again("focal length", [&] { scene.view.focal_px *= 1.1; });
  expect_drawn_again("lamp", [&] { scene.lamp.position_in_world.x() += 200; });
  expect_drawn_again("table", [&] { scene.table_in_world->max().x() += 50; });
  expect_drawn_again("grid", [&] { scene.table_grid_mm = 25; });
  expect_drawn_again("workspace", [&] { scene.workspace_in_world->max().z() += 50; });
  expect_drawn_again("camera", [&] { scene.cameras.pop_back(); });
  expect_drawn_again("background", [&] { scene.background_top = {0.2F, 0.2F, 0.2F}; });
}

// A part that changes: only the squares are drawn that it, or its shadow, was in or is in.
TEST_F(KeptPictures, FollowEveryChangeOfAPart) {
  Scene scene = OneSampleScene();
  const auto expect_renewed = [&](const char* what, const auto& change) {
    SCOPED_TRACE(what);
    for (int i = 0; i < 2; ++i) (void)kept_.Render(scene);
    const StillCount before = kept_.still_count();
    change();
    PutHandAt(scene, {55, 0, 225});
    ExpectSame(scene);
    EXPECT_EQ(kept_.still_count(), (StillCount{before.drawn, before.renewed + 1, before.kept}));
    ExpectSame(scene);
    EXPECT_EQ(kept_.still_count(), (StillCount{before.drawn, before.renewed + 1, before.kept + 1}));
  };
  expect_renewed("pose", [&] { scene.parts[3].world_from_part.translation_mm.z() += 20; });
  expect_renewed("colour", [&] { scene.parts[1].color = {0.2F, 0.5F, 0.3F}; });
  expect_renewed("contact", [&] { scene.parts[0].in_contact = true; });
  expect_renewed("opacity", [&] { scene.parts[4].opacity = 0.5F; });
  expect_renewed("mesh", [&] { scene.parts[1].mesh = BoxMesh({-30, -30, 0}, {30, 30, 90}); });
  expect_renewed("decal", [&] { scene.parts[1].is_decal = true; });
  expect_renewed("no decal", [&] { scene.parts[1].is_decal = false; });
  expect_renewed("hatched", [&] { scene.parts[1].is_cut_face = true; });
  expect_renewed("one part less", [&] { scene.parts.pop_back(); });
  expect_renewed("one part more", [&] { scene.parts.insert(scene.parts.begin() + 1, scene.parts[0]); });
}

// A layer that was renewed again and again has no trace of it: it is the one that is drawn at once.
TEST_F(KeptPictures, ThatWereRenewedAreThoseOfALayerDrawnAtOnce) {
  Scene scene = OneSampleScene();
  for (int i = 0; i < 2; ++i) (void)kept_.Render(scene);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> share(-1.0, 1.0);
  const int changes = 30 * test_support::SoakScale();
  for (int i = 0; i < changes; ++i) {
    ScenePart& part = scene.parts[random() % scene.parts.size()];
    switch (random() % 5) {
      case 0:
        part.world_from_part.translation_mm += 40.0 * Vector3d(share(random), share(random), 0.0);
        break;
      case 1:
        part.world_from_part.rotation =
            part.world_from_part.rotation * Eigen::AngleAxisd(share(random), Vector3d::UnitZ());
        break;
      case 2:
        part.in_contact = !part.in_contact;
        break;
      case 3:
        part.opacity = part.opacity < 1.0F ? 1.0F : 0.4F;
        break;
      default:
        part.world_from_part.translation_mm.z() += 30.0 * std::abs(share(random));
    }
    PutHandAt(scene, {150 * share(random), 120 * share(random), 200 + 150 * share(random)});
    SceneRenderer fresh;
    for (int j = 0; j < 2; ++j) (void)fresh.Render(scene);
    ASSERT_EQ(fresh.still_count().drawn, 1);
    for (int j = 0; j < 2; ++j) (void)kept_.Render(scene);
    ASSERT_EQ(kept_.Render(scene), fresh.Render(scene)) << "after " << i + 1 << " changes";
  }
  EXPECT_EQ(kept_.still_count().drawn, 1);
  EXPECT_GT(kept_.still_count().renewed, changes / 2);
  EXPECT_GT(kept_.square_count().left, kept_.square_count().drawn);
}

TEST_F(KeptPictures, AreNotTakenWhereTheyWouldDiffer) {
  Scene scene = OneSampleScene();
  scene.parts[0].world_from_part.translation_mm.z() -= 50.0;  // seen through the table
  for (int i = 0; i < 2; ++i) ExpectSame(scene);
  scene = OneSampleScene();
  scene.view.cam_from_world = core::CamFromWorldLookingAt({900, -600, -300}, {0, 0, 100});  // from below
  PutHandAt(scene, {55, 0, 225});
  for (int i = 0; i < 2; ++i) ExpectSame(scene);
  scene = TrialScene(kStillWidthPx, kStillHeightPx);  // four samples
  for (int i = 0; i < 2; ++i) ExpectSame(scene);
  EXPECT_EQ(kept_.still_count(), StillCount{});
}

TEST_F(KeptPictures, AreTheSameBytesAgainAndAgain) {
  Scene scene = OneSampleScene();
  for (int i = 0; i < 2; ++i) (void)kept_.Render(scene);
  const Image kept = kept_.Render(scene);
  Scene moved = scene;
  PutHandAt(moved, {-80, 40, 200});
  (void)kept_.Render(moved);
  EXPECT_EQ(kept_.Render(scene), kept);
  Scene wider = TrialScene(kStillWidthPx + 31, kStillHeightPx);
  wider.smoothness = Smoothness::kOneSample;
  for (int i = 0; i < 3; ++i) ExpectSame(wider);
}

// As the window asks for them: finer and coarser, in buffers that hold the finest.
TEST_F(KeptPictures, OfChangingFinenessAreThoseDrawnAnew) {
  struct Step {
    int width_px, height_px;
    double hull;
    Smoothness smoothness;
  };
  const std::vector<Step> steps = {
      {320, 240, 1.0, Smoothness::kFourSamples}, {320, 240, 1.0, Smoothness::kOneSample},
      {160, 120, 0.5, Smoothness::kOneSample},   {208, 156, 0.5, Smoothness::kOneSample},
      {256, 192, 0.5, Smoothness::kFourSamples}, {256, 192, 1.0, Smoothness::kOneSample}};
  std::mt19937 random(17);
  for (int i = 0; i < 24; ++i) {
    const Step& step =
        steps[i < static_cast<int>(steps.size()) ? static_cast<std::size_t>(i) : random() % steps.size()];
    SCOPED_TRACE(testing::Message() << step.width_px << " x " << step.height_px << ", hull " << step.hull);
    Scene scene = TrialScene(step.width_px, step.height_px);
    scene.smoothness = step.smoothness;
    const std::vector<Capsule> hand = Hand({-100.0 + 8.0 * i, 20.0, 225.0});
    scene.hull = CastLayer(scene.view, static_cast<int>(step.hull * step.width_px),
                           static_cast<int>(step.hull * step.height_px), hand);
    for (int j = 0; j < 3; ++j) {
      Scene in_room = scene;
      in_room.largest_px = {kStillWidthPx, kStillHeightPx};
      const Difference difference = DifferenceOf(kept_.Render(in_room), anew_.Render(scene));
      EXPECT_LE(difference.largest, 2) << difference.above_two << " channels";
    }
  }
  EXPECT_GT(kept_.still_count().kept, 0);
}

TEST(ShadowReach, HoldsEachPlaceThatReadsAHit) {
  HullView layer;
  layer.width_px = layer.height_px = 100;
  layer.depth_mm.assign(10'000, 0.0F);
  EXPECT_FALSE(ShadowReach(layer).Meets({Eigen::Vector2f(0, 0), Eigen::Vector2f(1, 1)}));
  EXPECT_FALSE(ShadowReach().Meets({Eigen::Vector2f(0, 0), Eigen::Vector2f(1, 1)}));
  std::mt19937 random(5);
  std::uniform_int_distribution<int> texel(0, 99);
  for (int i = 0; i < 40; ++i) {
    const int x = texel(random), y = texel(random);
    layer.depth_mm[static_cast<std::size_t>(100 * y + x)] = 500.0F;
    const ShadowReach reach(layer);
    for (const float beside : {-2.0F, 0.5F, 3.0F}) {  // texels from its left edge that read it
      const Eigen::Vector2f place((static_cast<float>(x) + beside) / 100.0F,
                                  (static_cast<float>(y) + 0.5F) / 100.0F);
      if ((place.array() < 0.0F).any() || (place.array() > 1.0F).any()) continue;
      EXPECT_TRUE(reach.Meets({place, place})) << place.transpose();
    }
  }
  layer.depth_mm.assign(10'000, 0.0F);
  layer.depth_mm[100 * 50 + 50] = 500.0F;
  const ShadowReach reach(layer);
  EXPECT_FALSE(reach.Meets({Eigen::Vector2f(0.0F, 0.0F), Eigen::Vector2f(0.4F, 1.0F)}));
  EXPECT_FALSE(reach.Meets({Eigen::Vector2f(0.6F, 0.0F), Eigen::Vector2f(1.0F, 1.0F)}));
  EXPECT_TRUE(reach.Meets({Eigen::Vector2f(0.0F, 0.45F), Eigen::Vector2f(1.0F, 0.55F)}));
  EXPECT_FALSE(reach.Meets({Eigen::Vector2f(1.5F, 0.0F), Eigen::Vector2f(2.0F, 1.0F)}));
}

}  // namespace
}  // namespace elbowroom::recon::gl
