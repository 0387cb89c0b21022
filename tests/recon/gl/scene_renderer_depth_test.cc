#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <vector>

#include "core/units.h"
#include "recon/appearance/orbit_camera.h"
#include "recon/gl/scene/scene_renderer.h"
#include "tests/recon/gl/sample_scene.h"

namespace elbowroom::recon::gl {
namespace {

// The stated bound: depth is stored in steps of 2^-24 in near/far units, and single precision on the way
// there costs as much again a few times.
double BoundMm(const SceneView& view, double depth_mm) {
  return 4.0 * std::ldexp(1.0, -24) * depth_mm * depth_mm / view.near_mm;
}

OrbitCamera OverTheShoulder() {
  OrbitCamera camera;
  camera.distance_mm = 900.0;
  camera.azimuth_rad = -0.7;
  camera.elevation_rad = 0.6;
  return camera;
}

std::size_t At(const SceneView& view, int x, int y) {
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(view.width_px) + static_cast<std::size_t>(x);
}

// Too near a silhouette edge for single precision to tell the sides apart.
bool OnARim(const SceneView& view, const Eigen::Vector2d& pixel, const Eigen::AlignedBox3d& box) {
  const bool here = BoxDepth(view, pixel, box).has_value();
  for (const double dx : {-0.01, 0.01}) {
    for (const double dy : {-0.01, 0.01}) {
      if (BoxDepth(view, pixel + Eigen::Vector2d(dx, dy), box).has_value() != here) return true;
    }
  }
  return false;
}

TEST(SceneRendererDepth, BoxIsWhereTheRaysMeetIt) {
  SceneRenderer renderer;
  const Eigen::AlignedBox3d box(Eigen::Vector3d(-120, -80, -60), Eigen::Vector3d(100, 90, 150));
  Scene scene;
  scene.parts.push_back({BoxMesh(box.min(), box.max()), {}});
  for (const double near_mm : {20.0, 200.0}) {
    scene.view = ViewFrom(OverTheShoulder(), 333, 241);  // odd sizes: the middle is a pixel
    scene.view.near_mm = near_mm;
    const DepthImage image = renderer.RenderDepth(scene);
    int hits = 0;
    double worst_share = 0.0;
    for (int y = 0; y < scene.view.height_px; ++y) {
      for (int x = 0; x < scene.view.width_px; ++x) {
        const Eigen::Vector2d pixel(x, y);
        if (OnARim(scene.view, pixel, box)) continue;
        const auto expected_mm = BoxDepth(scene.view, pixel, box);
        const double depth_mm = image.depth_mm[At(scene.view, x, y)];
        ASSERT_EQ(depth_mm > 0.0, expected_mm.has_value()) << x << ", " << y;
        if (!expected_mm) continue;
        ++hits;
        worst_share =
            std::max(worst_share, std::abs(depth_mm - *expected_mm) / BoundMm(scene.view, *expected_mm));
      }
    }
    EXPECT_GT(hits, 5000);
    EXPECT_LT(worst_share, 1.0) << "near " << near_mm;
  }
}

TEST(SceneRendererDepth, PosedPartIsWhereItsPosePutsIt) {
  SceneRenderer renderer;
  const Eigen::AlignedBox3d box(Eigen::Vector3d(-40, -30, 10), Eigen::Vector3d(60, 20, 90));
  Scene scene;
  scene.view = ViewFrom(OverTheShoulder(), 320, 240);
  scene.parts.push_back({BoxMesh(box.min(), box.max()), {}});
  const DepthImage still = renderer.RenderDepth(scene);
  const core::RigidTransform moved_from_world =
      core::FromPositionAndRollPitchYaw({300, -200, 120}, {20, -35, 50});
  scene.parts.front().world_from_part = moved_from_world;
  scene.view.cam_from_world = scene.view.cam_from_world * moved_from_world.Inverse();
  const DepthImage moved = renderer.RenderDepth(scene);
  int differing = 0;
  for (std::size_t i = 0; i < still.depth_mm.size(); ++i) {
    const double a = still.depth_mm[i], b = moved.depth_mm[i];
    if ((a > 0.0) != (b > 0.0) || std::abs(a - b) > 2.0 * BoundMm(scene.view, a)) ++differing;
  }
  EXPECT_LE(differing, 4);  // pixels whose centre rounding puts on the other side of a silhouette edge
}

TEST(SceneRendererDepth, TheHullComesThroughTexelForTexel) {
  SceneRenderer renderer;
  Scene scene;
  scene.view = ViewFrom(OverTheShoulder(), 320, 240);
  scene.hull = CastLayer(scene.view, 320, 240, Hand({0, 0, 0}));
  const DepthImage image = renderer.RenderDepth(scene);
  int hits = 0;
  for (std::size_t i = 0; i < image.depth_mm.size(); ++i) {
    const double expected_mm = scene.hull->depth_mm[i];
    ASSERT_EQ(image.depth_mm[i] > 0.0F, expected_mm > 0.0) << i;
    if (expected_mm == 0.0) continue;
    ++hits;
    EXPECT_NEAR(image.depth_mm[i], expected_mm, BoundMm(scene.view, expected_mm));
  }
  EXPECT_GT(hits, 3000);
}

// The nearer of the two surfaces at every pixel: hull before, behind and through a box.
TEST(SceneRendererDepth, HullAndPartHideEachOther) {
  SceneRenderer renderer;
  const Eigen::AlignedBox3d box(Eigen::Vector3d(-60, -60, -60), Eigen::Vector3d(60, 60, 60));
  Scene scene;
  scene.view = ViewFrom(OverTheShoulder(), 320, 240);
  scene.parts.push_back({BoxMesh(box.min(), box.max()), {}});
  const Eigen::Vector3d to_eye = scene.view.EyeInWorld().normalized();
  struct Case {
    double offset_mm;
    bool hull_owns;
    bool box_owns;
  };
  for (const Case& c : {Case{250.0, true, false}, Case{-250.0, false, true}, Case{48.0, true, true}}) {
    const std::vector<Capsule> ball{
        {c.offset_mm * to_eye, c.offset_mm * to_eye + Eigen::Vector3d(5, 0, 0), 40}};
    scene.hull = CastLayer(scene.view, 320, 240, ball);
    const DepthImage image = renderer.RenderDepth(scene);
    int hull_pixels = 0, box_pixels = 0;
    for (int y = 0; y < 240; ++y) {
      for (int x = 0; x < 320; ++x) {
        const double hull_mm = scene.hull->depth_mm[At(scene.view, x, y)];
        const auto box_mm = BoxDepth(scene.view, {x, y}, box);
        if (hull_mm == 0.0 || !box_mm || OnARim(scene.view, {x, y}, box)) continue;
        const double expected_mm = std::min(hull_mm, *box_mm);
        EXPECT_NEAR(image.depth_mm[At(scene.view, x, y)], expected_mm, BoundMm(scene.view, expected_mm));
        ++(hull_mm < *box_mm ? hull_pixels : box_pixels);
      }
    }
    EXPECT_EQ(hull_pixels > 100, c.hull_owns) << c.offset_mm;
    EXPECT_EQ(box_pixels > 100, c.box_owns) << c.offset_mm;
  }
}

// A triangle a good pixel wide around the point that projects on (200, 57) covers that centre alone.
TEST(SceneRendererDepth, PixelCentresAreAtIntegers) {
  SceneRenderer renderer;
  Scene scene;
  scene.view.width_px = 320;
  scene.view.height_px = 240;
  constexpr int kX = 200, kY = 57;
  const double depth_mm = 1000.0;
  const auto at = [&](double x, double y) {
    return Eigen::Vector3d(depth_mm * scene.view.RayInCam({x, y}));  // world is cam here
  };
  core::TriangleMesh mesh{{at(kX - 0.4, kY - 0.4), at(kX + 0.6, kY - 0.4), at(kX - 0.4, kY + 0.6)},
                          {{0, 1, 2}}};
  scene.parts.push_back({std::make_shared<const core::TriangleMesh>(mesh), {}});
  const DepthImage image = renderer.RenderDepth(scene);
  for (int y = 0; y < 240; ++y) {
    for (int x = 0; x < 320; ++x) {
      EXPECT_EQ(image.depth_mm[At(scene.view, x, y)] > 0.0F, x == kX && y == kY) << x << ", " << y;
    }
  }
}

TEST(SceneRendererDepth, NothingNearerThanNearOrFartherThanFarIsThere) {
  SceneRenderer renderer;
  Scene scene;
  scene.view.near_mm = 100.0;
  scene.view.far_mm = 1000.0;
  scene.parts.push_back({BoxMesh({-500, -500, 50}, {500, 500, 51}), {}});
  scene.parts.push_back({BoxMesh({-900, -900, 1100}, {900, 900, 1200}), {}});
  for (const float depth_mm : renderer.RenderDepth(scene).depth_mm) ASSERT_EQ(depth_mm, 0.0F);
}

}  // namespace
}  // namespace elbowroom::recon::gl
