#include "tests/oracles/analytic_hull.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include "recon/synthetic/demo_motion.h"
#include "recon/synthetic/rig_presets.h"

namespace elbowroom::oracles {
namespace {

using Eigen::Vector3d;

constexpr double kBallRadiusMm = 50.0;
// So far away that a sight cone around the ball is a cylinder to 5e-5 of its radius.
constexpr double kFarMm = 1e6;
constexpr double kCylinderShare = 1e-4;
constexpr double kBisectedMm = 1e-6;  // of a first surface, with room for the distance's last digits

core::CameraModel FarCamera(const Vector3d& direction) {
  core::CameraCalibration c;
  c.name = "far";
  c.image_width_px = c.image_height_px = 400;
  const double focal_px = 400.0 / (4.0 * kBallRadiusMm) * kFarMm;
  c.camera_matrix << focal_px, 0.0, 199.5, 0.0, focal_px, 199.5, 0.0, 0.0, 1.0;
  c.distortion_coefficients = {0, 0, 0, 0, 0};
  c.cam_from_world = core::CamFromWorldLookingAt(kFarMm * direction, Vector3d::Zero());
  return core::CameraModel(std::move(c));
}

core::Rig AxisRig(int cameras) {
  core::Rig rig;
  rig.workspace_mm = {Vector3d::Constant(-80.0), Vector3d::Constant(80.0)};
  for (int axis = 0; axis < cameras; ++axis) rig.cameras.push_back(FarCamera(Vector3d::Unit(axis)));
  return rig;
}

recon::Solid Ball(double radius_mm) { return {recon::Sphere{radius_mm}, {}, Vector3d::Constant(200.0)}; }

double VolumeMm3(const AnalyticHull& hull, double half_mm, int side) {
  std::int64_t inside = 0;
  const double cell_mm = 2.0 * half_mm / side;
  for (int i = 0; i < side * side * side; ++i) {
    const int x = i % side, y = i / side % side, z = i / (side * side);
    const Vector3d at(x + 0.5, y + 0.5, z + 0.5);
    inside += hull.Contains(cell_mm * at - Vector3d::Constant(half_mm)) ? 1 : 0;
  }
  return static_cast<double>(inside) * cell_mm * cell_mm * cell_mm;
}

TEST(AnalyticHull, OfABallSeenAlongTheAxesHasTheVolumeOfCrossedCylinders) {
  constexpr double kCountingShare = 3e-3;  // of 90^3 voxels
  const double r3 = kBallRadiusMm * kBallRadiusMm * kBallRadiusMm;
  const std::array solids{Ball(kBallRadiusMm)};
  EXPECT_NEAR(VolumeMm3({AxisRig(2), solids}, 51.0, 90) / (16.0 / 3.0 * r3), 1.0, kCountingShare);
  const double three = 8.0 * (2.0 - std::numbers::sqrt2) * r3;
  EXPECT_NEAR(VolumeMm3({AxisRig(3), solids}, 51.0, 90) / three, 1.0, kCountingShare);
}

TEST(AnalyticHull, OfABallSeenAlongTheAxesReachesWhereCrossedCylindersEnd) {
  const std::array solids{Ball(kBallRadiusMm)};
  const AnalyticHull two(AxisRig(2), solids), three(AxisRig(3), solids);
  const auto reach = [](const AnalyticHull& hull, const Vector3d& direction) {
    const Vector3d d = direction.normalized();
    const auto distance = hull.FirstSurface({100.0 * d, -d});
    return distance ? (100.0 - *distance) / kBallRadiusMm : 0.0;
  };
  const double root2 = std::numbers::sqrt2, root3 = std::numbers::sqrt3;
  EXPECT_NEAR(reach(two, {1, 0, 0}), 1.0, kCylinderShare);
  EXPECT_NEAR(reach(two, {1, 1, 0}), root2, kCylinderShare);
  EXPECT_NEAR(reach(two, {1, 0, 1}), 1.0, kCylinderShare);
  EXPECT_NEAR(reach(three, {1, 1, 0}), 1.0, kCylinderShare);
  EXPECT_NEAR(reach(three, {1, 1, 1}), root3 / root2, kCylinderShare);
  EXPECT_FALSE(two.FirstSurface({{100.0, 0.0, 51.0}, {-1.0, 0.0, 0.0}}).has_value());
}

TEST(AnalyticHull, FirstSurfaceIsTheSameWithoutPassingOverAnything) {
  const core::Rig rig = recon::PaperRig();
  const auto solids = recon::AllSolids(recon::DemoSceneAt(5.0).objects);
  const AnalyticHull hull(rig, solids);
  std::mt19937 random(11);
  std::uniform_real_distribution<double> place_mm(-60.0, 60.0);
  int hits = 0;
  for (int i = 0; i < 40; ++i) {
    const Vector3d target(60.0 + place_mm(random), place_mm(random), 190.0 + place_mm(random));
    const Vector3d eye = target + Vector3d(place_mm(random), -300.0, 200.0 + place_mm(random));
    const recon::Ray ray{eye, (target - eye).normalized()};
    constexpr double kStepMm = 0.5;
    const auto found = hull.FirstSurface(ray, {.step_mm = kStepMm});
    std::optional<double> truth;
    const auto span = ClipToBox(rig.workspace_mm, ray, 0.0);
    ASSERT_TRUE(span.has_value());
    for (int step = 0; !truth && span->first + step * kStepMm < span->second; ++step) {
      const long double t = span->first + step * kStepMm;
      if (hull.Contains(PointAt(ray, t).cast<double>())) truth = static_cast<double>(t);
    }
    ASSERT_EQ(found.has_value(), truth.has_value());
    if (!found) continue;
    ++hits;
    EXPECT_LE(*found, *truth + kBisectedMm);
    EXPECT_GE(*found, *truth - kStepMm - kBisectedMm);
    EXPECT_FALSE(hull.Contains(ray.origin_in_world + (*found - kBisectedMm) * ray.direction_in_world));
    EXPECT_TRUE(hull.Contains(ray.origin_in_world + (*found + kBisectedMm) * ray.direction_in_world));
  }
  EXPECT_GT(hits, 20);
}

TEST(AnalyticHull, ContainsTheSolids) {
  const core::Rig rig = recon::FourCameraRig();
  const auto solids = recon::AllSolids(recon::DemoSceneAt(5.0).objects);
  const AnalyticHull hull(rig, solids);
  std::mt19937 random(12);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  int inside = 0;
  for (int i = 0; i < 20'000; ++i) {
    const Vector3d x(150.0 + 250.0 * unit(random), 100.0 * unit(random), 200.0 + 150.0 * unit(random));
    const bool is_solid =
        std::ranges::any_of(solids, [&](const recon::Solid& s) { return recon::Contains(s, x); });
    inside += is_solid ? 1 : 0;
    if (is_solid) {
      EXPECT_TRUE(hull.Contains(x)) << x.transpose();
    }
  }
  EXPECT_GT(inside, 100);
}

TEST(AnalyticHull, BelievingAllCamerasMovedMovesTheHull) {
  const core::Rig rig = recon::PaperRig();
  const auto solids = recon::AllSolids(recon::DemoSceneAt(5.0).objects);
  const core::RigidTransform moved_from_world =
      core::FromPositionAndRollPitchYaw({3.0, -2.0, 1.0}, {0.4, -0.3, 0.5});
  std::vector<Sight> sights;
  for (const core::CameraModel& camera : rig.cameras) {
    core::CameraCalibration believed = camera.calibration();
    believed.cam_from_world = camera.cam_from_world() * moved_from_world.Inverse();
    sights.push_back({core::CameraModel(believed), camera.cam_from_world(), solids});
  }
  const AnalyticHull hull(rig, solids), moved(rig.workspace_mm, rig.unseen, sights);
  const Vector3d eye(300.0, -500.0, 500.0);
  int hits = 0;
  for (double x_mm = 0.0; x_mm < 300.0; x_mm += 20.0) {
    const recon::Ray ray{eye, (Vector3d(x_mm, 0.0, 200.0) - eye).normalized()};
    const auto found = hull.FirstSurface(ray);
    const auto after = moved.FirstSurface(
        {moved_from_world * ray.origin_in_world, moved_from_world.rotation * ray.direction_in_world});
    ASSERT_EQ(found.has_value(), after.has_value());
    if (!found) continue;
    ++hits;
    EXPECT_NEAR(*found, *after, kBisectedMm);
  }
  EXPECT_GT(hits, 5);
}

TEST(CoveringBalls, CoverTheSolid) {
  std::mt19937 random(13);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  for (const recon::Solid& solid : recon::AllSolids(recon::DemoSceneAt(12.0).objects)) {
    const auto balls = CoveringBalls(solid);
    const recon::BoundingSphere around = recon::BoundingSphereOf(solid);
    for (int i = 0; i < 300; ++i) {
      const Vector3d x =
          around.center_in_world + around.radius_mm * Vector3d(unit(random), unit(random), unit(random));
      if (!recon::Contains(solid, x)) continue;
      EXPECT_TRUE(std::ranges::any_of(balls, [&](const recon::BoundingSphere& ball) {
        return (x - ball.center_in_world).norm() <= ball.radius_mm + 1e-9;
      }));
    }
  }
}

}  // namespace
}  // namespace elbowroom::oracles
