// Parts placed by the hand: drags, faces, holes and measured points, held against slow searches.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "app/control/placing/cylinder_fit.h"
#include "app/control/placing/drag.h"
#include "app/control/placing/rigid_fit.h"
#include "app/control/placing/snap.h"
#include "app/control/placing/surface_patch.h"
#include "core/error.h"
#include "core/units.h"
#include "tests/app/layouts/box_file.h"

namespace elbowroom::control {
namespace {

using Eigen::Vector3d;
using test_support::Wall;

constexpr double kRounding = 1e-9;  // mm or radians, of lengths of some hundred mm in double

class Placing : public testing::Test {
 protected:
  double Number(double most) { return std::uniform_real_distribution<double>(-most, most)(random_); }
  Vector3d Vector(double most) { return {Number(most), Number(most), Number(most)}; }
  Vector3d Direction() {
    Vector3d v = Vector(1.0);
    while (v.norm() < 0.1) v = Vector(1.0);
    return v.normalized();
  }
  core::RigidTransform Pose() { return core::FromPositionAndRollPitchYaw(Vector(300.0), Vector(180.0)); }

  std::mt19937 random_{25};
};

std::vector<std::uint32_t> AllOf(const core::TriangleMesh& mesh) {
  std::vector<std::uint32_t> all(mesh.triangles.size());
  for (std::uint32_t i = 0; i < all.size(); ++i) all[i] = i;
  return all;
}

double AngleBetween(const Vector3d& a, const Vector3d& b) { return std::atan2(a.cross(b).norm(), a.dot(b)); }

TEST_F(Placing, TheNearestPlaceOnAnAxisIsThatOfASearch) {
  const auto distance = [](const AxisLine& axis, const PickRay& ray, double along_mm) {
    const Vector3d x = axis.point_in_world + along_mm * axis.direction_in_world - ray.origin_in_world;
    return x.cross(ray.direction_in_world).norm();
  };
  for (int run = 0; run < 200; ++run) {
    const AxisLine axis{Vector(200.0), Direction()};
    const PickRay ray{Vector(1000.0), Direction()};
    const auto along = NearestAlong(axis, ray);
    if (AngleBetween(axis.direction_in_world, ray.direction_in_world) < 0.3) continue;
    ASSERT_TRUE(along);
    double low = -1e5, high = 1e5;  // the distance is convex along the axis: thirds
    for (int i = 0; i < 400; ++i) {
      const double a = low + (high - low) / 3.0, b = high - (high - low) / 3.0;
      (distance(axis, ray, a) < distance(axis, ray, b) ? high : low) =
          distance(axis, ray, a) < distance(axis, ray, b) ? b : a;
    }
    EXPECT_NEAR(*along, 0.5 * (low + high), 1e-3) << run;
  }
}

TEST_F(Placing, LookingAlongAnAxisGivesNothing) {
  EXPECT_FALSE(
      NearestAlong({Vector3d::Zero(), Vector3d::UnitZ()}, {Vector3d(1.0, 0.0, 9.0), -Vector3d::UnitZ()}));
  EXPECT_FALSE(
      DirectionAbout({Vector3d::Zero(), Vector3d::UnitZ()}, {Vector3d(9.0, 0.0, 0.0), -Vector3d::UnitX()}));
  EXPECT_FALSE(
      DirectionAbout({Vector3d::Zero(), Vector3d::UnitZ()}, {Vector3d(1.0, 0.0, 9.0), Vector3d::UnitZ()}));
}

TEST_F(Placing, ADragAroundTurnsByTheAngleThatThePointWentAround) {
  for (int run = 0; run < 200; ++run) {
    const AxisLine axis{Vector(200.0), Direction()};
    const Vector3d arm = 80.0 * axis.direction_in_world.unitOrthogonal();
    const double angle = Number(3.0);
    const Vector3d eye = axis.point_in_world + 900.0 * (axis.direction_in_world + 0.3 * Direction());
    const auto at = [&](double turn) {
      const Vector3d x = axis.point_in_world + Eigen::AngleAxisd(turn, axis.direction_in_world) * arm;
      return DirectionAbout(axis, {eye, (x - eye).normalized()});
    };
    const auto before = at(0.0), after = at(angle);
    ASSERT_TRUE(before && after);
    EXPECT_NEAR(std::remainder(*after - *before - angle, 2.0 * std::numbers::pi), 0.0, kRounding);
    const core::RigidTransform pose = Pose();
    const core::RigidTransform turned = TurnedAbout(axis, angle, pose);
    const Vector3d x_in_part = pose.Inverse() * (axis.point_in_world + arm);
    EXPECT_LT(
        (turned * x_in_part - (axis.point_in_world + Eigen::AngleAxisd(angle, axis.direction_in_world) * arm))
            .norm(),
        kRounding);
  }
}

TEST_F(Placing, NumbersSnapToTheNearestStep) {
  EXPECT_DOUBLE_EQ(Snapped(12.6, 1.0), 13.0);
  EXPECT_DOUBLE_EQ(Snapped(-12.6, 5.0), -15.0);
  EXPECT_DOUBLE_EQ(Snapped(12.6, 0.0), 12.6);
}

TEST_F(Placing, AFaceOnAFaceIsCoplanarAndOpposed) {
  for (int run = 0; run < 500; ++run) {
    const core::RigidTransform pose = Pose();
    const FacePlace in_part{Vector(60.0), Direction()};
    const FacePlace moving{pose * in_part.point_in_world, pose.rotation * in_part.normal_in_world};
    FacePlace fixed{Vector(300.0), Direction()};
    if (run % 5 == 0) fixed.normal_in_world = moving.normal_in_world;   // half a turn
    if (run % 5 == 1) fixed.normal_in_world = -moving.normal_in_world;  // no turn
    const core::RigidTransform placed = FaceToFace(pose, moving, fixed);
    ASSERT_TRUE(core::IsRotation(placed.rotation, 1e-9));
    const Vector3d point = placed * in_part.point_in_world;
    EXPECT_LT((placed.rotation * in_part.normal_in_world + fixed.normal_in_world).norm(), kRounding);
    EXPECT_NEAR(fixed.normal_in_world.dot(point - fixed.point_in_world), 0.0, kRounding);
    // Nothing slides along the plane, and the turn is the smallest that there is.
    EXPECT_LT((point - moving.point_in_world).cross(fixed.normal_in_world).norm(), kRounding);
    const Eigen::AngleAxisd turn(Eigen::Matrix3d(placed.rotation * pose.rotation.transpose()));
    EXPECT_NEAR(turn.angle(), AngleBetween(moving.normal_in_world, -fixed.normal_in_world), 1e-7);
  }
}

TEST_F(Placing, AnAxisOnAnAxisIsOneLine) {
  for (int run = 0; run < 500; ++run) {
    const core::RigidTransform pose = Pose();
    const AxisLine in_part{Vector(60.0), Direction()};
    const AxisLine moving{pose * in_part.point_in_world, pose.rotation * in_part.direction_in_world};
    const AxisLine fixed{Vector(300.0), Direction()};
    const core::RigidTransform placed = AxisToAxis(pose, moving, fixed);
    const Vector3d point = placed * in_part.point_in_world;
    EXPECT_LT((placed.rotation * in_part.direction_in_world).cross(fixed.direction_in_world).norm(),
              kRounding);
    EXPECT_LT((point - fixed.point_in_world).cross(fixed.direction_in_world).norm(), 1e-8);
    EXPECT_NEAR((point - moving.point_in_world).dot(fixed.direction_in_world), 0.0, 1e-8);
    const Eigen::AngleAxisd turn(Eigen::Matrix3d(placed.rotation * pose.rotation.transpose()));
    EXPECT_LE(turn.angle(), 0.5 * std::numbers::pi + kRounding);  // whichever way it points
  }
}

TEST_F(Placing, TheAxisOfAHoleIsFoundFromItsWall) {
  for (int run = 0; run < 300; ++run) {
    const double radius_mm = 1.0 + std::abs(Number(40.0)), length_mm = 2.0 + std::abs(Number(50.0));
    const double around_rad = 1.2 + std::abs(Number(5.0));
    const bool is_hole = run % 2 == 0;
    const core::RigidTransform pose = Pose();
    const core::TriangleMesh mesh = core::Transformed(
        Wall(radius_mm, length_mm, std::min(around_rad, 2.0 * std::numbers::pi), 24, is_hole), pose);
    const auto fit = FitCylinder(mesh, AllOf(mesh));
    ASSERT_TRUE(fit) << run;
    EXPECT_NEAR(fit->radius_mm, radius_mm, 1e-7);
    EXPECT_NEAR(fit->length_mm, length_mm, 1e-7);
    EXPECT_EQ(fit->is_hole, is_hole);
    EXPECT_LT(fit->direction.cross(pose.rotation.col(2)).norm(), 1e-8);
    EXPECT_LT((fit->point - pose * Vector3d(0.0, 0.0, 0.5 * length_mm)).norm(), 1e-6);
  }
}

TEST_F(Placing, WhatIsNoCylinderHasNoAxis) {
  const core::TriangleMesh box = test_support::BoxMesh({100.0, 80.0, 60.0});
  EXPECT_FALSE(FitCylinder(box, std::vector<std::uint32_t>{0, 1}));  // a plane
  EXPECT_FALSE(FitCylinder(box, AllOf(box)));
  EXPECT_FALSE(FitCylinder(box, {}));
  const core::TriangleMesh shallow = Wall(50.0, 20.0, 0.3, 12, false);
  EXPECT_FALSE(FitCylinder(shallow, AllOf(shallow)));  // goes around by too little
  core::TriangleMesh cone = Wall(10.0, 20.0, 6.0, 24, false);
  for (Vector3d& x : cone.vertices_mm)
    if (x.z() > 0.0) x.head<2>() *= 1.5;
  EXPECT_FALSE(FitCylinder(cone, AllOf(cone)));
}

TEST_F(Placing, AFaceIsWhatHangsSmoothlyTogether) {
  const core::TriangleMesh box = test_support::BoxMesh({100.0, 80.0, 60.0});
  for (std::uint32_t i = 0; i < box.triangles.size(); ++i) {
    const std::vector<std::uint32_t> patch = SmoothPatch(box, i, 1.0);
    EXPECT_EQ(patch, (std::vector<std::uint32_t>{i / 2 * 2, i / 2 * 2 + 1}));
  }
  EXPECT_EQ(SmoothPatch(box, 0, 91.0).size(), box.triangles.size());
  core::TriangleMesh both = test_support::BoxMesh({100.0, 80.0, 60.0});
  core::Append(both, Wall(10.0, 60.0, 2.0 * std::numbers::pi, 24, true));
  EXPECT_EQ(SmoothPatch(both, 12, 30.0).size(), 48U);  // the wall and nothing of the box
}

TEST_F(Placing, MeasuredPointsGiveBackTheMotion) {
  for (int run = 0; run < 200; ++run) {
    const core::RigidTransform pose = Pose();
    std::vector<PointPair> pairs;
    for (int i = 0; i < 3 + run % 5; ++i) {
      const Vector3d x = Vector(200.0);
      pairs.push_back({x, pose * x});
    }
    const RigidFit fit = FitRigid(pairs);
    EXPECT_TRUE(core::IsRotation(fit.world_from_part.rotation, 1e-9));
    EXPECT_LT((fit.world_from_part.rotation - pose.rotation).norm(), 1e-7);
    EXPECT_LT((fit.world_from_part.translation_mm - pose.translation_mm).norm(), 1e-5);
    EXPECT_LT(fit.largest_mm, 1e-6);
  }
}

// The oracle: no motion nearby has a smaller sum of squares.
TEST_F(Placing, NoMotionNearbyFitsMeasuredPointsBetter) {
  const auto squares = [](const std::vector<PointPair>& pairs, const core::RigidTransform& motion) {
    double sum = 0.0;
    for (const PointPair& pair : pairs) sum += (motion * pair.x_in_part - pair.x_in_world).squaredNorm();
    return sum;
  };
  for (int run = 0; run < 50; ++run) {
    const core::RigidTransform pose = Pose();
    std::vector<PointPair> pairs;
    for (int i = 0; i < 4; ++i) {
      const Vector3d x = Vector(200.0);
      pairs.push_back({x, pose * x + Vector(run < 25 ? 1.0 : 60.0)});
    }
    const RigidFit fit = FitRigid(pairs);
    const double least = squares(pairs, fit.world_from_part);
    EXPECT_NEAR(fit.rms_mm, std::sqrt(least / 4.0), 1e-9);
    for (int i = 0; i < 400; ++i) {
      const double size = std::pow(10.0, -4.0 * i / 400.0);
      const AxisLine axis{fit.world_from_part.translation_mm, Direction()};
      core::RigidTransform other = TurnedAbout(axis, size * Number(3.0), fit.world_from_part);
      other.translation_mm += size * Vector(50.0);
      EXPECT_GE(squares(pairs, other), least - 1e-6);
    }
  }
}

TEST_F(Placing, PointsOnALineOrTooFewAreRefused) {
  EXPECT_THROW((void)FitRigid({{Vector3d::Zero(), Vector3d::Zero()}, {Vector3d::UnitX(), Vector3d::UnitX()}}),
               core::Error);
  std::vector<PointPair> line;
  for (const double along : {0.0, 10.0, 35.0, 80.0})
    line.push_back({along * Vector3d::UnitX(), along * Vector3d::UnitY()});
  EXPECT_THROW((void)FitRigid(line), core::Error);
  line.push_back({Vector3d(20.0, 15.0, 0.0), Vector3d(-15.0, 20.0, 0.0)});
  EXPECT_LT(FitRigid(line).largest_mm, 1e-9);
}

}  // namespace
}  // namespace elbowroom::control
