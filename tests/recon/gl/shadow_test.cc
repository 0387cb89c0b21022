// Shadows where geometry says they fall, nowhere else, and drawn only when something changed.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <optional>
#include <vector>

#include "core/error.h"
#include "recon/appearance/orbit_camera.h"
#include "recon/gl/scene/scene_renderer.h"
#include "tests/recon/gl/sample_scene.h"

namespace elbowroom::recon::gl {
namespace {

using Eigen::Vector3d;

constexpr int kWidthPx = 400, kHeightPx = 300;
constexpr int kHullFromLampPx = 768;
const Eigen::AlignedBox3d kGround(Vector3d(-300, -300, -20), Vector3d(300, 300, 0));

Scene LampScene() {
  Scene scene;
  OrbitCamera camera;
  camera.target_in_world = {20, 20, 30};
  camera.distance_mm = 1300.0;
  camera.elevation_rad = 1.0;
  scene.view = ViewFrom(camera, kWidthPx, kHeightPx);
  scene.lamp = LampOver({Vector3d(-300, -300, -20), Vector3d(300, 300, 320)});
  return scene;
}

ScenePart WhitePart(const Eigen::AlignedBox3d& box) {
  return {BoxMesh(box.min(), box.max()), {}, {0.8F, 0.8F, 0.8F}};
}

void AddHull(Scene& scene, const std::vector<Capsule>& capsules) {
  scene.hull = CastLayer(scene.view, kWidthPx, kHeightPx, capsules);
  scene.hull_from_lamp =
      CastLayer(scene.lamp.ShadowView(kHullFromLampPx), kHullFromLampPx, kHullFromLampPx, capsules);
}

// The lamp's shadow map doesn't reach the scene: everything is lit alike, without a shadow.
Scene Unshadowed(Scene scene) {
  scene.lamp.target_in_world = 2.0 * scene.lamp.position_in_world;
  scene.lamp.reach_mm = 1.0;
  scene.hull_from_lamp.reset();
  return scene;
}

bool Meets(const Eigen::AlignedBox3d& box, const Vector3d& from, const Vector3d& to) {
  const Eigen::Array3d step = (to - from).array();
  const Eigen::Array3d a = (box.min() - from).array() / step, b = (box.max() - from).array() / step;
  return std::max(a.min(b).maxCoeff(), 0.0) < std::min(a.max(b).minCoeff(), 1.0);
}

bool Meets(const Capsule& ball, const Vector3d& from, const Vector3d& to) {
  const Vector3d step = to - from;
  const double share = std::clamp((ball.a_in_world - from).dot(step) / step.squaredNorm(), 0.0, 1.0);
  return (from + share * step - ball.a_in_world).norm() < ball.radius_mm;
}

// A small piece of surface seen in the pixel.
struct Spot {
  Vector3d x_in_world;
  Vector3d normal_in_world;
};
using SpotAt = std::function<std::optional<Spot>(int x, int y)>;
using IsBlocked = std::function<bool(const Vector3d& x_in_world)>;

// What every place around the spot within that distance says of the lamp; nothing where they disagree.
std::optional<bool> BlockedAround(const Spot& spot, double distance_mm, const IsBlocked& is_blocked) {
  const Vector3d along = spot.normal_in_world.unitOrthogonal();
  const Vector3d across = spot.normal_in_world.cross(along);
  const bool here = is_blocked(spot.x_in_world);
  for (int i = 0; i < 16; ++i) {
    const double angle_rad = 2.0 * std::numbers::pi * i / 16;
    const Vector3d there =
        spot.x_in_world + distance_mm * (std::cos(angle_rad) * along + std::sin(angle_rad) * across);
    if (is_blocked(there) != here) return std::nullopt;
  }
  return here;
}

struct Tally {
  int shaded = 0, lit = 0;
};

// What the spot lacks of the light that the lamp would give to it, in grey levels.
void ExpectMissing(int missing, bool is_blocked, double at_least, double at_most) {
  if (is_blocked) {
    EXPECT_GT(missing, at_least);
  } else {
    EXPECT_LE(missing, at_most);
  }
}

// Compares the picture with one without shadows at every spot. Of the light that the lamp gives to a spot,
// all is missing in its shadow and nothing outside, but for a band of the filter's width at the shadow's
// edge; and half of it is missing within one texel of the edge.
Tally ExpectShadows(const Scene& scene, const SpotAt& spot_at, const IsBlocked& is_blocked, int map_px) {
  constexpr double kLeastCosine = 0.35;  // of incidence; grazing spots have wide bands and little light
  constexpr int kRounding = 3;           // grey levels: two pictures, samples at slightly other places
  constexpr double kKeyShare = 0.42 * 0.8 * 255.0;  // grey levels that the lamp gives to a white part head on
  SceneRenderer renderer;
  const Image with = renderer.Render(scene);
  const Image without = renderer.Render(Unshadowed(scene));
  const SceneView from_lamp = scene.lamp.ShadowView(map_px);
  Tally tally;
  for (int y = 0; y < kHeightPx; ++y) {
    for (int x = 0; x < kWidthPx; ++x) {
      const std::optional<Spot> spot = spot_at(x, y);
      if (!spot) continue;
      const Vector3d to_lamp = scene.lamp.position_in_world - spot->x_in_world;
      const double cosine = spot->normal_in_world.dot(to_lamp.normalized());
      if (cosine < kLeastCosine) continue;
      const double texel_mm = to_lamp.norm() / from_lamp.focal_px / cosine;  // on the surface, its long side
      const auto pixel = static_cast<std::size_t>(3 * (y * kWidthPx + x));
      const int missing = without.rgb[pixel] - with.rgb[pixel];
      SCOPED_TRACE(testing::Message() << x << ", " << y);
      constexpr double kFilterTexels =
          2.0 * std::numbers::sqrt2 + 0.5;  // half its diagonal; the map's raster
      constexpr double kPixelMm = 3.0;      // of the picture, on these surfaces
      if (const auto blocked = BlockedAround(*spot, kFilterTexels * texel_mm + kPixelMm, is_blocked)) {
        ExpectMissing(missing, *blocked, 0.8 * kKeyShare * cosine - kRounding, kRounding);
        ++(*blocked ? tally.shaded : tally.lit);
      } else if (const auto beside = BlockedAround(*spot, 1.0 * texel_mm + kPixelMm, is_blocked)) {
        ExpectMissing(missing, *beside, 0.35 * kKeyShare * cosine - kRounding,
                      0.65 * kKeyShare * cosine + kRounding);
      }
    }
  }
  return tally;
}

// The ground where nothing stands before it; a few millimetres off its rim and off what stands on it.
SpotAt GroundSpots(const Scene& scene, const std::function<bool(const Vector3d&)>& is_hidden) {
  return [&scene, is_hidden](int x, int y) -> std::optional<Spot> {
    const Vector3d eye = scene.view.EyeInWorld();
    const Vector3d ray = scene.view.cam_from_world.rotation.transpose() * scene.view.RayInCam({x, y});
    const Vector3d at = eye - eye.z() / ray.z() * ray;
    constexpr double kRimMm = 8.0;  // edge lines are drawn there
    if (at.head<2>().cwiseAbs().maxCoeff() > 300.0 - kRimMm || is_hidden(at)) return std::nullopt;
    return Spot{at, Vector3d::UnitZ()};
  };
}

TEST(Shadow, OfABoxFallsWhereItMustOnAPartAndTouchesItsFoot) {
  for (const double lifted_mm : {0.0, 15.0, 150.0}) {
    Scene scene = LampScene();
    const Eigen::AlignedBox3d box(Vector3d(-60, -40, lifted_mm), Vector3d(60, 40, lifted_mm + 60));
    scene.parts = {WhitePart(kGround), WhitePart(box)};
    const Vector3d lamp = scene.lamp.position_in_world, eye = scene.view.EyeInWorld();
    constexpr double kEdgeLineMm = 8.0;
    const Eigen::AlignedBox3d around(box.min().array() - kEdgeLineMm, box.max().array() + kEdgeLineMm);
    const Tally tally = ExpectShadows(
        scene, GroundSpots(scene, [&](const Vector3d& at) { return Meets(around, at, eye); }),
        [&](const Vector3d& at) { return Meets(box, at + Vector3d(0, 0, 1e-6), lamp); },
        scene.lamp.part_shadow_px);
    EXPECT_GT(tally.shaded, 300) << lifted_mm;
    EXPECT_GT(tally.lit, 5000) << lifted_mm;
  }
}

TEST(Shadow, OfTheHullFallsOnAPart) {
  Scene scene = LampScene();
  const Capsule ball{{0, 0, 150}, {0, 0, 150.001}, 60};
  scene.parts = {WhitePart(kGround)};
  AddHull(scene, {ball});
  const Vector3d lamp = scene.lamp.position_in_world, eye = scene.view.EyeInWorld();
  const Capsule around{ball.a_in_world, ball.b_in_world, ball.radius_mm + 8.0};  // its soft rim
  const Tally tally = ExpectShadows(
      scene, GroundSpots(scene, [&](const Vector3d& at) { return Meets(around, at, eye); }),
      [&](const Vector3d& at) { return Meets(ball, at, lamp); }, kHullFromLampPx);
  EXPECT_GT(tally.shaded, 500);
  EXPECT_GT(tally.lit, 5000);
}

TEST(Shadow, OfAPartFallsOnTheHull) {
  Scene scene = LampScene();
  scene.hull_color = {0.8F, 0.8F, 0.8F};
  const Capsule ball{{0, 0, 0}, {0, 0, 0.001}, 150};
  AddHull(scene, {ball});
  const Vector3d lamp = scene.lamp.position_in_world, eye = scene.view.EyeInWorld();
  const Vector3d middle = 0.12 * lamp.normalized() * lamp.norm();
  const Eigen::AlignedBox3d box(middle.array() - 35.0, middle.array() + 35.0);
  scene.parts = {WhitePart(box)};
  const Eigen::AlignedBox3d around(box.min().array() - 8.0, box.max().array() + 8.0);
  const Tally tally = ExpectShadows(
      scene,
      [&](int x, int y) -> std::optional<Spot> {
        const auto hit = CastRay(scene.view, {x, y}, {ball});
        if (!hit) return std::nullopt;
        const Vector3d at =
            scene.view.cam_from_world.Inverse() * (hit->depth_mm * scene.view.RayInCam({x, y}));
        constexpr double kTurnedToTheEye = 0.4;  // the rim is tinted and soft
        if (hit->normal_in_world.dot((eye - at).normalized()) < kTurnedToTheEye || Meets(around, at, eye))
          return std::nullopt;
        return Spot{at, hit->normal_in_world};
      },
      [&](const Vector3d& at) { return Meets(box, at, lamp); }, scene.lamp.part_shadow_px);
  EXPECT_GT(tally.shaded, 300);
  EXPECT_GT(tally.lit, 1000);
}

TEST(Shadow, TheTableTakesShadowsOfBoth) {
  SceneRenderer renderer;
  Scene scene = LampScene();
  scene.table_in_world = Eigen::AlignedBox2d(Eigen::Vector2d(-300, -300), Eigen::Vector2d(300, 300));
  scene.table_grid_mm = 1e6;  // no lines
  scene.parts = {WhitePart({Vector3d(-160, -40, 100), Vector3d(-80, 40, 110)})};
  AddHull(scene, {{{120, 0, 105}, {120, 0, 105.001}, 40}});
  const Image with = renderer.Render(scene);
  const Image without = renderer.Render(Unshadowed(scene));
  for (const Vector3d& caster : {Vector3d(-120, 0, 105), Vector3d(120, 0, 105)}) {
    const Vector3d ray = caster - scene.lamp.position_in_world;
    const Vector3d at = caster - caster.z() / ray.z() * ray;
    const Eigen::Vector2i pixel = scene.view.Project(at).value().array().round().cast<int>();
    const auto first = static_cast<std::size_t>(3 * (pixel.y() * kWidthPx + pixel.x()));
    EXPECT_LT(with.rgb[first], without.rgb[first] - 40) << caster.x();
  }
}

// All neighbours up to two pixels away hit something too. On the very outline a sample may show the inside of
// a part's far wall, which is in its own shadow rightly.
bool IsInsideOfOutline(const DepthImage& depth, int x, int y) {
  for (int i = 0; i < 25; ++i) {
    const int at = (y + i / 5 - 2) * depth.width_px + x + i % 5 - 2;
    if (depth.depth_mm[static_cast<std::size_t>(at)] == 0.0F) return false;
  }
  return true;
}

// Plates at every slope to the lamp, from head on to grazing, are as bright as without shadows.
TEST(Shadow, NothingShadesItself) {
  constexpr int kVisible = 8;  // grey levels; the bias is cut off where the lamp grazes (docs/appearance.md)
  SceneRenderer renderer;
  int checked = 0;
  for (int turn = 0; turn < 40; ++turn) {
    Scene scene = LampScene();
    scene.parts = {WhitePart({Vector3d(-120, -120, -2), Vector3d(120, 120, 2)})};
    scene.parts[0].world_from_part =
        core::FromPositionAndRollPitchYaw({0, 0, 60}, {9.0 * turn, 13.0 * turn, 29.0 * turn});
    const Image with = renderer.Render(scene);
    const Image without = renderer.Render(Unshadowed(scene));
    const DepthImage depth = renderer.RenderDepth(scene);
    int darkest = 0;
    for (int y = 2; y + 2 < kHeightPx; ++y) {
      for (int x = 2; x + 2 < kWidthPx; ++x) {
        if (!IsInsideOfOutline(depth, x, y)) continue;
        const auto pixel = static_cast<std::size_t>(3 * (y * kWidthPx + x));
        darkest = std::max(darkest, without.rgb[pixel] - with.rgb[pixel]);
        ++checked;
      }
    }
    EXPECT_LE(darkest, kVisible) << turn;
  }
  EXPECT_GT(checked, 50'000);
}

TEST(Shadow, AHullDoesNotShadeItsLitSide) {
  SceneRenderer renderer;
  Scene scene = LampScene();
  const Capsule ball{{0, 0, 100}, {0, 0, 100.001}, 120};
  AddHull(scene, {ball});
  const Image with = renderer.Render(scene);
  const Image without = renderer.Render(Unshadowed(scene));
  int checked = 0;
  for (int y = 0; y < kHeightPx; ++y) {
    for (int x = 0; x < kWidthPx; ++x) {
      const auto hit = CastRay(scene.view, {x, y}, {ball});
      if (!hit) continue;
      const auto pixel = static_cast<std::size_t>(3 * (y * kWidthPx + x));
      EXPECT_LE(without.rgb[pixel] - with.rgb[pixel], 8) << x << ", " << y;
      ++checked;
    }
  }
  EXPECT_GT(checked, 5000);
}

TEST(Shadow, PassesAreSkippedWhileNothingChanges) {
  SceneRenderer renderer;
  Scene scene = TrialScene(160, 120);
  const Image first = renderer.Render(scene);
  EXPECT_EQ(first, renderer.Render(scene));
  scene.view.cam_from_world.translation_mm.x() += 20.0;  // another view of the same things
  (void)renderer.Render(scene);
  EXPECT_EQ(renderer.shadow_count().part_passes, 1);
  EXPECT_EQ(renderer.shadow_count().kept_part_passes, 2);
  EXPECT_EQ(renderer.shadow_count().hull_uploads, 1);
  EXPECT_EQ(renderer.shadow_count().kept_hull_uploads, 2);
  scene.parts[0].color = {0, 0, 0};  // nothing to a shadow
  (void)renderer.Render(scene);
  EXPECT_EQ(renderer.shadow_count().part_passes, 1);
  scene.parts[0].world_from_part.translation_mm.x() += 1.0;
  (void)renderer.Render(scene);
  EXPECT_EQ(renderer.shadow_count().part_passes, 2);
  EXPECT_EQ(renderer.shadow_count().hull_uploads, 1);
  scene.hull_from_lamp = std::make_shared<const HullView>(*scene.hull_from_lamp);
  (void)renderer.Render(scene);
  EXPECT_EQ(renderer.shadow_count().part_passes, 2);
  EXPECT_EQ(renderer.shadow_count().hull_uploads, 2);
  scene.lamp.position_in_world.x() += 10.0;
  (void)renderer.Render(scene);
  EXPECT_EQ(renderer.shadow_count().part_passes, 3);
  EXPECT_EQ(renderer.shadow_count().hull_uploads, 3);
}

TEST(Shadow, WhatWasDrawnBeforeDoesNotChangeAPicture) {
  Scene scene = TrialScene(160, 120);
  SceneRenderer fresh, used;
  Scene other = scene;
  other.parts.pop_back();
  other.hull_from_lamp.reset();
  (void)used.Render(other);
  EXPECT_EQ(fresh.Render(scene), used.Render(scene));
}

TEST(Shadow, PartsOutsideTheLampsConeAreLeftOut) {
  SceneRenderer renderer;
  Scene scene = LampScene();
  scene.parts = {WhitePart(kGround), WhitePart({Vector3d(5000, 0, 0), Vector3d(5100, 100, 100)})};
  (void)renderer.Render(scene);
  EXPECT_EQ(renderer.shadow_count().parts_outside_lamp, 1);
}

TEST(SceneLamp, ItsViewHoldsTheBallAroundItsTarget) {
  const Eigen::AlignedBox3d box(Vector3d(-400, -300, 0), Vector3d(500, 300, 500));
  const SceneLamp lamp = LampOver(box);
  lamp.Validate();
  const SceneView view = lamp.ShadowView(100);
  view.Validate();
  for (int i = 0; i < 8; ++i) {
    const Vector3d corner = box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(i));
    const auto place = view.Project(corner);
    ASSERT_TRUE(place.has_value());
    EXPECT_TRUE((place->array() >= -0.5).all() && (place->array() <= 99.5).all()) << place->transpose();
    const double depth_mm = (view.cam_from_world * corner).z();
    EXPECT_TRUE(depth_mm > view.near_mm && depth_mm < view.far_mm);
  }
  SceneLamp inside = lamp;
  inside.reach_mm = 1e5;
  EXPECT_THROW(inside.Validate(), core::PreconditionError);
}

}  // namespace
}  // namespace elbowroom::recon::gl
