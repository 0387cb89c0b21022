// Volumes of balls' hulls against formulas, and against a sum over directions from the ball's middle.
#include "recon/coverage/ball_hull.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "tests/recon/coverage/ball_rigs.h"

namespace elbowroom::recon {
namespace {

using Eigen::Vector3d;

constexpr double kShareError = 0.004;        // what ball_hull.h states of the default rays, at most
constexpr double kMedianShareError = 0.001;  // and in the median
constexpr double kFarMm = 1e5;               // cones of a ball of 10 mm are cylinders to 1e-4 there

double PhantomAtOrigin(const core::Rig& rig, double radius_mm, int rings = 5) {
  BallHull::Scratch scratch;
  const auto volume = BallHull(rig, rings).At(Vector3d::Zero(), radius_mm, &scratch);
  EXPECT_TRUE(volume.has_value());
  return volume ? volume->phantom_fraction() : -1.0;
}

TEST(BallHull, FarOrthogonalCamerasMakeSteinmetzSolids) {
  const double ball = 4.0 * std::numbers::pi / 3.0;
  const double of_two = 1.0 - ball / (16.0 / 3.0),
               of_three = 1.0 - ball / (8.0 * (2.0 - std::numbers::sqrt2));
  EXPECT_NEAR(of_two, 0.2146, 1e-4);
  EXPECT_NEAR(of_three, 0.1061, 1e-4);
  Random random(1);
  for (int i = 0; i < 50; ++i) {
    const Eigen::Matrix3d axes = kFarMm * random.Rotation();
    const std::array<Vector3d, 3> eyes = {axes.col(0), axes.col(1), axes.col(2)};
    EXPECT_NEAR(PhantomAtOrigin(RigAt(std::span(eyes).first(2), 1e5, Cube(100.0)), 10.0), of_two,
                kShareError);
    EXPECT_NEAR(PhantomAtOrigin(RigAt(eyes, 1e5, Cube(100.0)), 10.0), of_three, kShareError);
  }
}

TEST(BallHull, OfOneCameraIsAConeThatTheWorkspaceEnds) {
  for (const auto unseen : {core::UnseenPolicy::kOutside, core::UnseenPolicy::kAbstain}) {
    // Far away: a cylinder, 200 mm long.
    const std::array<Vector3d, 1> far = {Vector3d(0.0, 0.0, kFarMm)};
    EXPECT_NEAR(PhantomAtOrigin(RigAt(far, 1e5, Cube(100.0), unseen), 10.0), 1.0 - 4.0 * 10.0 / (3.0 * 200.0),
                kShareError);
    // Near: a frustum from 900 to 1100 mm, of which the tangent of the half angle is 10 / sqrt(1000^2 -
    // 10^2).
    const std::array<Vector3d, 1> near = {Vector3d(0.0, 0.0, 1000.0)};
    const double slope2 = 100.0 / (1e6 - 100.0);
    const double frustum_mm3 = std::numbers::pi * slope2 * (std::pow(1100.0, 3) - std::pow(900.0, 3)) / 3.0;
    EXPECT_NEAR(PhantomAtOrigin(RigAt(near, 1000.0, Cube(100.0), unseen), 10.0),
                1.0 - 4.0 / 3.0 * std::numbers::pi * 1e3 / frustum_mm3, kShareError);
  }
}

TEST(BallHull, TheWorkspaceCutsBallAndHull) {
  // Six far cameras along the axes, and the ball on a face of the workspace: half of it counts.
  std::vector<Vector3d> eyes;
  for (int axis = 0; axis < 3; ++axis) {
    eyes.push_back(kFarMm * Vector3d::Unit(axis));
    eyes.push_back(-kFarMm * Vector3d::Unit(axis));
  }
  const core::Rig rig = RigAt(eyes, 1e5, {Vector3d(-100, -100, 0), Vector3d(100, 100, 100)});
  BallHull::Scratch scratch;
  const BallHullVolume volume = BallHull(rig).At(Vector3d::Zero(), 10.0, &scratch).value();
  EXPECT_NEAR(volume.ball_mm3 / (2.0 / 3.0 * std::numbers::pi * 1e3), 1.0, 0.01);
  EXPECT_NEAR(volume.phantom_fraction(), 0.1061, kShareError);
}

TEST(BallHull, NothingWhereNoHullCanBe) {
  const std::array<Vector3d, 2> eyes = {Vector3d(1000.0, 0.0, 0.0), Vector3d(0.0, 1000.0, 0.0)};
  const core::Rig outside = RigAt(eyes, 2000.0, Cube(500.0));
  const core::Rig abstain = RigAt(eyes, 2000.0, Cube(500.0), core::UnseenPolicy::kAbstain);
  BallHull::Scratch scratch;
  const Vector3d seen_by_one(800.0 - 400.0, 0.0, 0.0), seen_by_none(0.0, 0.0, 480.0);
  EXPECT_TRUE(BallHull(outside).At(Vector3d::Zero(), 25.0, &scratch));
  EXPECT_FALSE(BallHull(outside).At(seen_by_one, 25.0, &scratch));
  EXPECT_TRUE(BallHull(abstain).At(seen_by_one, 25.0, &scratch));
  EXPECT_FALSE(BallHull(abstain).At(seen_by_none, 25.0, &scratch));
  EXPECT_FALSE(BallHull(outside).At({0.0, 0.0, 501.0}, 25.0, &scratch)) << "not in the workspace";
  EXPECT_FALSE(BallHull(outside).At(Vector3d::Zero(), 1001.0, &scratch)) << "a camera is in the ball";
}

TEST(BallHull, ShrinksWhenACameraIsAdded) {
  Random random(2);
  for (int i = 0; i < 40; ++i) {
    std::vector<Vector3d> eyes;
    double last = 1.0;
    for (int cameras = 1; cameras <= 8; ++cameras) {
      eyes.push_back(random.Uniform(400.0, 2000.0) * random.Direction());
      const double share = PhantomAtOrigin(RigAt(eyes, 500.0, Cube(300.0)), 25.0);
      EXPECT_LE(share, last + kShareError) << i << ", " << cameras;
      last = share;
    }
  }
}

// The oracle: sum over directions from the ball's middle of (distance to the hull's surface)^3 / 3, with the
// distance to each camera's cone by formula. A hull of a ball that all cameras see is convex and holds its
// middle, so it is star-shaped about it.
double PhantomByDirections(const core::Rig& rig, double radius_mm, int directions) {
  double hull = 0.0, ball = 0.0;
  for (int i = 0; i < directions; ++i) {
    const double z = 1.0 - 2.0 * (i + 0.5) / directions, across = std::sqrt(1.0 - z * z);
    const double turn = 2.0 * std::numbers::pi * i / std::numbers::phi;
    const Vector3d way(across * std::cos(turn), across * std::sin(turn), z);
    double reach = 1e9;
    for (Eigen::Index axis = 0; axis < 3; ++axis)
      reach = std::min(reach, rig.workspace_mm.max()[axis] / std::max(std::abs(way[axis]), 1e-12));
    const double ball_reach = std::min(reach, radius_mm);
    for (const core::CameraModel& camera : rig.cameras) {
      // From the middle, at D from the eye, along a way at the angle b to the axis; the cone's half angle is
      // a. The point at s is on the cone where the angle at the eye is a: sine rule.
      const Vector3d axis = -camera.center_in_world().normalized();
      const double d = camera.center_in_world().norm();
      const double half_angle = std::asin(radius_mm / d);
      const double angle = std::acos(std::clamp(way.dot(axis), -1.0, 1.0));
      if (angle > half_angle)
        reach = std::min(reach, d * std::sin(half_angle) / std::sin(angle - half_angle));
    }
    hull += reach * reach * reach;
    ball += ball_reach * ball_reach * ball_reach;
  }
  return 1.0 - ball / hull;
}

TEST(BallHull, IsTheSumOverDirections) {
  constexpr int kDirections = 200000;
  Random random(3);
  std::vector<double> errors;
  for (int i = 0; i < 120; ++i) {
    std::vector<Vector3d> eyes;
    for (int camera = random.Whole(2, 8); camera > 0; --camera)
      eyes.push_back(random.LogUniform(150.0, 5000.0) * random.Direction());
    const core::Rig rig = RigAt(eyes, 300.0, Cube(random.Uniform(80.0, 400.0)));
    const double truth = PhantomByDirections(rig, 25.0, kDirections);
    errors.push_back(std::abs(PhantomAtOrigin(rig, 25.0) - truth));
    EXPECT_LE(errors.back(), kShareError) << i << ": " << truth;
    EXPECT_NEAR(PhantomAtOrigin(rig, 25.0, 20), truth, 0.001) << i;  // the oracle's own error
  }
  std::ranges::sort(errors);
  std::printf("phantom share, 60 rays: error %.5f in the median, %.5f at most\n", errors[errors.size() / 2],
              errors.back());
  EXPECT_LE(errors[errors.size() / 2], kMedianShareError);
}

}  // namespace
}  // namespace elbowroom::recon
