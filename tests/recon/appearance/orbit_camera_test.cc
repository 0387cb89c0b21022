#include "recon/appearance/orbit_camera.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "core/error.h"

namespace elbowroom::recon {
namespace {

constexpr double kRoundingMm = 1e-9;  // doubles, coordinates of a few thousand millimetres
constexpr double kRoundingPx = 1e-9;
constexpr int kWidthPx = 640;
constexpr int kHeightPx = 480;

OrbitCamera RandomCamera(std::mt19937& random) {
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  OrbitCamera camera;
  camera.target_in_world = 500.0 * Eigen::Vector3d(unit(random), unit(random), unit(random));
  camera.distance_mm = 1500.0 + 1000.0 * unit(random);
  camera.azimuth_rad = std::numbers::pi * unit(random);
  camera.elevation_rad = 0.5 * std::numbers::pi * unit(random);
  camera.vertical_fov_rad = 0.8 + 0.5 * unit(random);
  return camera;
}

TEST(OrbitCamera, StandsWhereItsAnglesSayAndLooksAtItsTarget) {
  std::mt19937 random(1);
  for (int i = 0; i < 200; ++i) {
    const OrbitCamera camera = RandomCamera(random);
    const SceneView view = ViewFrom(camera, kWidthPx, kHeightPx);
    const Eigen::Vector3d offset(std::cos(camera.elevation_rad) * std::cos(camera.azimuth_rad),
                                 std::cos(camera.elevation_rad) * std::sin(camera.azimuth_rad),
                                 std::sin(camera.elevation_rad));
    EXPECT_LT((view.EyeInWorld() - camera.target_in_world - camera.distance_mm * offset).norm(), kRoundingMm);
    const auto pixel = view.Project(camera.target_in_world);
    ASSERT_TRUE(pixel);
    EXPECT_LT((*pixel - Eigen::Vector2d(319.5, 239.5)).norm(), kRoundingPx);
    // World up never points down in the picture.
    EXPECT_LE(view.cam_from_world.rotation(1, 2), 1e-12);
    EXPECT_NEAR(view.cam_from_world.rotation(0, 2), 0.0, 1e-12);
  }
}

TEST(OrbitCamera, AgreesWithLookingAtWhereThatHasAnUp) {
  OrbitCamera camera;
  camera.target_in_world = {10, 20, 30};
  const SceneView view = ViewFrom(camera, kWidthPx, kHeightPx);
  const core::RigidTransform expected =
      core::CamFromWorldLookingAt(view.EyeInWorld(), camera.target_in_world);
  EXPECT_LT((view.cam_from_world.rotation - expected.rotation).norm(), 1e-12);
  EXPECT_LT((view.cam_from_world.translation_mm - expected.translation_mm).norm(), kRoundingMm);
}

TEST(OrbitCamera, StraightDownIsAViewLikeAnyOther) {
  OrbitCamera camera;
  camera.elevation_rad = 0.5 * std::numbers::pi;
  camera.azimuth_rad = -0.5 * std::numbers::pi;
  const SceneView view = ViewFrom(camera, kWidthPx, kHeightPx);
  const auto right = view.Project({100, 0, 0});
  const auto away = view.Project({0, 100, 0});
  ASSERT_TRUE(right && away);
  EXPECT_GT(right->x(), 319.5 + 10);
  EXPECT_NEAR(right->y(), 239.5, kRoundingPx);
  EXPECT_LT(away->y(), 239.5 - 10);
}

TEST(OrbitCamera, FieldOfViewSpansThePicturesHeight) {
  OrbitCamera camera;
  camera.elevation_rad = 0.0;
  const SceneView view = ViewFrom(camera, kWidthPx, kHeightPx);
  const double half_mm = camera.distance_mm * std::tan(0.5 * camera.vertical_fov_rad);
  const auto top = view.Project(Eigen::Vector3d(0, 0, half_mm));
  ASSERT_TRUE(top);
  EXPECT_NEAR(top->y(), -0.5, kRoundingPx);  // the upper rim of the first row
}

TEST(OrbitCamera, SceneFollowsAnOrbitingDrag) {
  OrbitCamera camera;
  const Eigen::Vector3d near_side =
      camera.target_in_world +
      100.0 * (ViewFrom(camera, kWidthPx, kHeightPx).EyeInWorld() - camera.target_in_world).normalized();
  const auto pixel_after = [&](const Eigen::Vector2d& drag_px) {
    return ViewFrom(Orbited(camera, drag_px, kHeightPx), kWidthPx, kHeightPx).Project(near_side).value();
  };
  EXPECT_GT(pixel_after({20, 0}).x(), 319.5 + 1);
  EXPECT_GT(pixel_after({0, 20}).y(), 239.5 + 1);
  EXPECT_NEAR(Orbited(camera, {kHeightPx, 0}, kHeightPx).azimuth_rad,
              camera.azimuth_rad - std::numbers::pi + 2 * std::numbers::pi, 1e-12);
}

TEST(OrbitCamera, ElevationStopsOverhead) {
  EXPECT_DOUBLE_EQ(Orbited({}, {0, 1e6}, kHeightPx).elevation_rad, 0.5 * std::numbers::pi);
  EXPECT_DOUBLE_EQ(Orbited({}, {0, -1e6}, kHeightPx).elevation_rad, -0.5 * std::numbers::pi);
}

TEST(OrbitCamera, ZoomingInAndOutComesBackAndStopsAtItsLimits) {
  const OrbitCamera camera;
  EXPECT_NEAR(Zoomed(camera, 1.0).distance_mm, 0.9 * camera.distance_mm, kRoundingMm);
  EXPECT_NEAR(Zoomed(Zoomed(camera, 3.0), -3.0).distance_mm, camera.distance_mm, kRoundingMm);
  EXPECT_DOUBLE_EQ(Zoomed(camera, 1e4).distance_mm, 10.0);
  EXPECT_DOUBLE_EQ(Zoomed(camera, -1e4).distance_mm, 100'000.0);
}

TEST(OrbitCamera, PanKeepsTheTargetUnderThePointer) {
  std::mt19937 random(2);
  for (int i = 0; i < 50; ++i) {
    const OrbitCamera camera = RandomCamera(random);
    const Eigen::Vector2d drag_px(37.0, -81.0);
    const SceneView view = ViewFrom(Panned(camera, drag_px, kHeightPx), kWidthPx, kHeightPx);
    const auto pixel = view.Project(camera.target_in_world);
    ASSERT_TRUE(pixel);
    EXPECT_LT((*pixel - view.PrincipalPoint() - drag_px).norm(), kRoundingPx);
  }
}

TEST(OrbitCamera, FitShowsTheWholeBoxAndTouchesItsMargin) {
  std::mt19937 random(3);
  for (int i = 0; i < 200; ++i) {
    const Eigen::AlignedBox3d box(Eigen::Vector3d(-300, -100, 0), Eigen::Vector3d(200, 350, 240));
    const OrbitCamera camera = FittedTo(RandomCamera(random), box, kWidthPx, kHeightPx);
    const SceneView view = ViewFrom(camera, kWidthPx, kHeightPx);
    double reach = 0.0;  // 1: at the rim of the picture
    for (int corner = 0; corner < 8; ++corner) {
      const auto pixel = view.Project(box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(corner)));
      ASSERT_TRUE(pixel);
      const Eigen::Vector2d from_center = *pixel - view.PrincipalPoint();
      reach = std::max({reach, std::abs(from_center.x()) / (0.5 * kWidthPx),
                        std::abs(from_center.y()) / (0.5 * kHeightPx)});
    }
    EXPECT_NEAR(reach, 0.9, 1e-9);
  }
}

TEST(OrbitCamera, NonsenseIsABug) {
  OrbitCamera camera;
  EXPECT_THROW((void)ViewFrom(camera, 0, 480), core::PreconditionError);
  EXPECT_THROW((void)FittedTo(camera, Eigen::AlignedBox3d(), 640, 480), core::PreconditionError);
  camera.vertical_fov_rad = 4.0;
  EXPECT_THROW((void)ViewFrom(camera, 640, 480), core::PreconditionError);
}

TEST(OrbitCamera, StandardViewsLookAlongTheWorldsAxes) {
  std::mt19937 random(7);
  const OrbitCamera camera = RandomCamera(random);
  // Right and up in the picture, in world.
  const auto expect = [&](StandardView which, const Eigen::Vector3d& right, const Eigen::Vector3d& up) {
    const OrbitCamera along = Along(camera, which);
    EXPECT_EQ(along.target_in_world, camera.target_in_world);
    EXPECT_EQ(along.distance_mm, camera.distance_mm);
    const Eigen::Matrix3d rows = ViewFrom(along, kWidthPx, kHeightPx).cam_from_world.rotation;
    EXPECT_LT((rows.row(0).transpose() - right).norm(), 1e-12) << static_cast<int>(which);
    EXPECT_LT((rows.row(1).transpose() + up).norm(), 1e-12) << static_cast<int>(which);
  };
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX(), y = Eigen::Vector3d::UnitY(),
                        z = Eigen::Vector3d::UnitZ();
  expect(StandardView::kFront, x, z);
  expect(StandardView::kBack, -x, z);
  expect(StandardView::kRight, y, z);
  expect(StandardView::kLeft, -y, z);
  expect(StandardView::kTop, x, y);
  expect(StandardView::kBottom, x, -y);
  const SceneView isometric = ViewFrom(Along(camera, StandardView::kIsometric), kWidthPx, kHeightPx);
  const Eigen::Matrix3d rows = isometric.cam_from_world.rotation;
  for (int axis = 1; axis < 3; ++axis)
    EXPECT_NEAR(rows.col(axis).head<2>().norm(), rows.col(0).head<2>().norm(), 1e-12);
}

TEST(OrbitCamera, ParallelViewsKeepLengthsWhereverTheyAre) {
  std::mt19937 random(8);
  for (int i = 0; i < 50; ++i) {
    OrbitCamera camera = RandomCamera(random);
    const SceneView perspective = ViewFrom(camera, kWidthPx, kHeightPx);
    camera.is_parallel = true;
    const SceneView parallel = ViewFrom(camera, kWidthPx, kHeightPx);
    const Eigen::Vector3d right = perspective.cam_from_world.rotation.row(0),
                          forward = perspective.cam_from_world.rotation.row(2);
    const auto px_at = [&](const SceneView& view, double behind_mm) {
      const Eigen::Vector3d x = camera.target_in_world + behind_mm * forward;
      return (*view.Project(x + 100.0 * right) - *view.Project(x)).norm();
    };
    const double at_target = px_at(perspective, 0.0);
    for (const double share : {-0.25, 0.0, 0.25})
      EXPECT_NEAR(px_at(parallel, share * camera.distance_mm), at_target, 0.001 * at_target);
    EXPECT_LT(parallel.near_mm, 256.0 * camera.distance_mm - 0.9 * camera.distance_mm);
  }
}

TEST(OrbitCamera, StandsWhereACameraOfTheRigStands) {
  const core::CameraModel camera =
      CameraOf(ViewFrom({.target_in_world = {10, 20, 30}, .distance_mm = 900.0}, 320, 240));
  const Eigen::Vector3d center(10, 20, 30);
  const OrbitCamera like = OrbitLike(camera, center);
  EXPECT_LT((ViewFrom(like, 320, 240).EyeInWorld() - camera.center_in_world()).norm(), 1e-9);
  EXPECT_LT((like.target_in_world - center).norm(), 1e-9);
  // Its own view falls on the same pixels but for scale.
  const SceneView view = ViewFrom(camera, center, 640, 480);
  for (const Eigen::Vector3d& point : {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(80, -40, 120)}) {
    const Eigen::Vector2d small = *camera.Project(point);
    const Eigen::Vector2d large = *view.Project(point);
    EXPECT_LT((large - (2.0 * small + Eigen::Vector2d(0.5, 0.5))).norm(), 1e-9);
  }
}

}  // namespace
}  // namespace elbowroom::recon
