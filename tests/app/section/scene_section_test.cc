// Parts and hull cut open in the 3-D view: nothing beyond a plane is drawn, and the cut has faces.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <vector>

#include "app/control/scene_composer.h"
#include "core/infinity.h"
#include "recon/appearance/orbit_camera.h"
#include "recon/exact_view/hull_view.h"
#include "recon/gl/scene/scene_renderer.h"
#include "recon/hull/ray_crossings.h"
#include "recon/hull/visual_hull.h"
#include "tests/app/demo_frame.h"

namespace elbowroom::control {
namespace {

using Eigen::Vector3d;

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

CutPixels Count(const recon::gl::Scene& scene, const recon::HalfSpace& kept, double slack_mm) {
  static recon::gl::SceneRenderer renderer;
  const recon::gl::DepthImage depth = renderer.RenderDepth(scene);
  const core::RigidTransform world_from_cam = scene.view.cam_from_world.Inverse();
  CutPixels count;
  for (int y = 0; y < depth.height_px; ++y) {
    for (int x = 0; x < depth.width_px; ++x) {
      const double depth_mm = depth.depth_mm[static_cast<std::size_t>(y * depth.width_px + x)];
      if (depth_mm <= 0.0) continue;
      const Vector3d at = world_from_cam * (scene.view.RayInCam({x, y}) * depth_mm);
      const double off_mm = -kept.BeyondMm(at);
      ++count.seen;
      count.beyond += off_mm < -slack_mm ? 1 : 0;
      count.on_plane += std::abs(off_mm) <= slack_mm ? 1 : 0;
    }
  }
  return count;
}

// How far along, in lengths of `along`, a ray is first in the hull and in all half-spaces.
std::optional<double> FirstKeptMm(const recon::VisualHull& hull, const Vector3d& origin,
                                  const Vector3d& along, const std::vector<recon::HalfSpace>& kept) {
  double from = 0.0, to = core::kInfinity;
  for (const recon::HalfSpace& plane : kept) {
    const double beyond = plane.BeyondMm(origin), climbs = plane.outward.dot(along);
    if (climbs > 0.0) to = std::min(to, -beyond / climbs);
    if (climbs < 0.0) from = std::max(from, -beyond / climbs);
  }
  if (from > to) return std::nullopt;
  const double length = along.norm();
  const std::optional<double> first =
      recon::FirstInside(hull, {origin, along / length}, {from * length, to * length});
  return first ? std::optional(*first / length) : std::nullopt;
}

// Across an axis, through the hand at an angle, and along the pipe.
std::vector<recon::HalfSpace> Planes() {
  const Vector3d oblique = Vector3d(0.35, -1.0, 0.25).normalized(),
                 steep = Vector3d(0.6, -0.5, -0.6).normalized();
  const Vector3d through(0.0, 5.0, 210.0);
  return {{-Vector3d::UnitY(), -5.0}, {oblique, oblique.dot(through)}, {steep, steep.dot(through)}};
}

TEST(SceneSection, ShowsNothingBeyondThePlaneAndClosesTheCut) {
  const SharedFrameResult frame = DemoFrame();
  for (const recon::HalfSpace& plane : Planes()) {
    SceneLook look;
    look.cut.kept = {plane};
    for (const bool is_parallel : {false, true}) {
      // The depth buffer's rounding; a parallel view's eye is far away.
      const double slack_mm = is_parallel ? 3.0 : 0.6;
      SceneComposer composer;
      recon::gl::Scene scene = composer.Compose(*frame, FrontView(is_parallel), look);
      scene.table_in_world.reset();  // it isn't cut
      const CutPixels all = Count(scene, plane, slack_mm);
      EXPECT_GT(all.seen, 3000);
      EXPECT_EQ(all.beyond, 0) << plane.outward.transpose();
      EXPECT_GT(all.on_plane, 1000);
      recon::gl::Scene hull_alone = scene;
      hull_alone.parts.clear();
      const CutPixels hull = Count(hull_alone, plane, slack_mm);
      EXPECT_GT(hull.on_plane, 20);  // the pipe and the hand, cut through
      EXPECT_EQ(hull.beyond, 0);
      scene.hull = nullptr;
      EXPECT_GT(Count(scene, plane, slack_mm).on_plane, 500);
    }
  }
}

// The view in double precision that knows no planes: a ray meets the cut hull in the first point of its
// intervals in the whole hull that the planes keep.
TEST(SceneSection, TheCutHullIsTheWholeHullsIntervalsClippedByThePlanes) {
  const SharedFrameResult frame = DemoFrame();
  const std::vector<recon::HalfSpace> planes = Planes();
  for (const std::vector<recon::HalfSpace>& kept :
       {std::vector{planes[0]}, std::vector{planes[1]}, std::vector{planes[1], planes[2]}}) {
    const recon::ViewRays rays = recon::ViewRays(recon::CameraOf(FrontView(false))).Within(kept);
    const recon::HullView view = recon::ViewHull(*frame->hull, rays);
    EXPECT_GT(view.hit_pixels, 500);
    const core::RigidTransform world_from_view = rays.view_from_world().Inverse();
    int disagree = 0, on_planes = 0;
    for (int y = 0; y < view.height_px; ++y) {
      for (int x = 0; x < view.width_px; ++x) {
        const Eigen::Vector2d uv = rays.At(x, y);
        const Vector3d along = world_from_view.rotation * Vector3d(uv.x(), uv.y(), 1.0);
        const std::optional<double> depth_mm =
            FirstKeptMm(*frame->hull, world_from_view.translation_mm, along, kept);
        const auto pixel = static_cast<std::size_t>(y * view.width_px + x);
        const double seen_mm = view.depth_mm[pixel];
        // Float32's last bits; a hull thinner than that along the ray may be passed (docs/exact_view.md).
        if (!depth_mm || seen_mm == 0.0) {
          disagree += depth_mm.has_value() != (seen_mm != 0.0) ? 1 : 0;
          continue;
        }
        ASSERT_NEAR(seen_mm, *depth_mm, 1e-5 * *depth_mm) << x << " " << y;
        const Vector3d at = world_from_view.translation_mm + *depth_mm * along;
        for (const recon::HalfSpace& plane : kept) {
          if (std::abs(plane.BeyondMm(at)) > 1e-6) continue;
          ++on_planes;
          EXPECT_LT((view.normal_in_world[pixel].cast<double>() - plane.outward).norm(), 1e-6);
          EXPECT_FALSE(view.surface[pixel].camera());
        }
      }
    }
    EXPECT_LE(disagree, 2);  // rays that graze the hull
    EXPECT_GT(on_planes, 200);
  }
}

TEST(SceneSection, IsMadeOnceAndForgottenWithTheCut) {
  const SharedFrameResult frame = DemoFrame();
  SceneLook look;
  SceneComposer composer;
  const recon::SceneView view = FrontView(false);
  const std::size_t whole_parts = composer.Compose(*frame, view, look).parts.size();
  look.cut.kept = {{Vector3d::UnitX(), 20.0}};
  const recon::gl::Scene cut = composer.Compose(*frame, view, look),
                         again = composer.Compose(*frame, view, look);
  EXPECT_GT(cut.parts.size(), whole_parts);  // faces of the cut are parts of their own
  ASSERT_EQ(cut.parts.size(), again.parts.size());
  for (std::size_t i = 0; i < cut.parts.size(); ++i) EXPECT_EQ(cut.parts[i].mesh, again.parts[i].mesh);
  EXPECT_EQ(cut.hull, again.hull);
  EXPECT_EQ(composer.Compose(*frame, view).parts.size(), whole_parts);
  // Everything cut away: an empty picture, not an error.
  look.cut.kept = {{Vector3d::UnitX(), -1e4}};
  const recon::gl::Scene nothing = composer.Compose(*frame, view, look);
  EXPECT_TRUE(nothing.parts.empty());
  EXPECT_EQ(nothing.hull->hit_pixels, 0);
}

}  // namespace
}  // namespace elbowroom::control
