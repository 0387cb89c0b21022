// Rigid parts that are pushed, against a hull whose faces are known and parts that stand in the way.
#include "review/pushed_part.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <memory>
#include <vector>

#include "core/error.h"
#include "review/contacts.h"
#include "tests/core/solids.h"
#include "tests/review/box_hull.h"

namespace elbowroom::review {
namespace {

using Eigen::Vector3d;

constexpr double kPushFrameS = 1.0 / 30.0;
constexpr double kPushRoundingMm = 1e-6;

SurfaceModel BoxModel(const Vector3d& size_mm) {
  return SurfaceModel(std::make_shared<const core::TriangleMesh>(core::testing::Box(size_mm)));
}

core::RigidTransform At(double x_mm, double y_mm, double z_mm) {
  return {Eigen::Matrix3d::Identity(), Vector3d(x_mm, y_mm, z_mm)};
}

core::Part Pushed(const SurfaceModel& model, const core::RecoveryRule& recovery, double max_speed_mm_per_s) {
  core::Part part;
  part.name = "pushed";
  part.mesh = model.tree().shared_mesh();
  part.recovery = recovery;
  part.gives_way = core::PushRule{.max_speed_mm_per_s = max_speed_mm_per_s};
  return part;
}

const core::RecoveryRule kSlider{core::RecoveryKind::kSlider, {}, Vector3d::UnitX(), {}};
constexpr double kSlowMmPerS = 150.0, kFastMmPerS = 10000.0;

// A part, where it rests, and the others about it.
struct Table {
  const SurfaceModel& model;
  core::Part part;
  core::RigidTransform world_from_rest;
  std::vector<StandingPart> others = {};
  recon::VisualHull hull = BoxHull();  // [-50, 50]^3

  [[nodiscard]] core::PartContact ContactAt(const PushState& state) const {
    return FindContacts(hull, model.tree(), world_from_rest * state.rest_from_part, 0,
                        {.recovery = part.recovery});
  }
  [[nodiscard]] bool Touches(const PushState& state) const {
    return ContactAt(state).verdict == core::Verdict::kContact;
  }
  [[nodiscard]] PushState Step(const PushState& state, double dt_s = kPushFrameS) const {
    return StepPush(part, ContactAt(state), state, {&model, world_from_rest}, others, hull, dt_s);
  }
};

TEST(PushedPart, LeavesTheHullAlongItsSliderNoFasterThanItMay) {
  const SurfaceModel model = BoxModel({40.0, 20.0, 20.0});
  // 18 mm in: the short way is +x.
  const Table table{model, Pushed(model, kSlider, kSlowMmPerS), At(32.0, -10.0, -10.0)};
  PushState state = table.Step({});
  EXPECT_NEAR(state.went_mm, 5.0, kPushRoundingMm);  // 150 mm/s for 1/30 s
  EXPECT_NEAR(state.wanted_mm, 18.5, 0.5);
  for (int i = 0; i < 5; ++i) state = table.Step(state);
  EXPECT_FALSE(table.Touches(state));
  EXPECT_NEAR(state.rest_from_part.translation_mm.x(), 18.5, 0.5);
  EXPECT_EQ(state.rest_from_part.translation_mm.y(), 0.0);
  EXPECT_EQ(table.Step(state).rest_from_part, state.rest_from_part) << "it stays where it was pushed";
}

TEST(PushedPart, WithoutAnAxisItGoesTowardsItsReference) {
  const SurfaceModel model = BoxModel({60.0, 20.0, 20.0});
  const Table table{model, Pushed(model, {}, 1000.0), At(40.0, -10.0, -10.0)};
  PushState state;
  for (int i = 0; i < 8; ++i) state = table.Step(state);
  EXPECT_FALSE(table.Touches(state));
  EXPECT_GT(state.rest_from_part.translation_mm.x(), 5.0);
}

TEST(PushedPart, ADirectionIsGoneInItsSenseAlone) {
  const SurfaceModel model = BoxModel({40.0, 20.0, 20.0});
  const core::RecoveryRule back{core::RecoveryKind::kDirection, {}, -Vector3d::UnitX(), {}};
  const Table table{model, Pushed(model, back, kFastMmPerS), At(32.0, -10.0, -10.0)};
  PushState state;
  for (int i = 0; i < 3; ++i) state = table.Step(state);
  EXPECT_FALSE(table.Touches(state));
  EXPECT_NEAR(state.rest_from_part.translation_mm.x(), -122.5, 0.6) << "through the hull, not back out of it";
}

TEST(PushedPart, ADoorTurnsAboutItsHingeUntilItIsFree) {
  // A leaf 120 mm long along y whose hinge stands beside the hull's face at x = 50; its far end is 15 mm in.
  const SurfaceModel model = BoxModel({4.0, 120.0, 20.0});
  const core::RecoveryRule hinge{core::RecoveryKind::kHinge, {}, Vector3d::UnitZ(), Vector3d::Zero()};
  core::RigidTransform pose = At(60.0, -60.0, -10.0);
  pose.rotation = Eigen::AngleAxisd(std::asin(25.0 / 120.0), Vector3d::UnitZ()).toRotationMatrix();
  const Table table{model, Pushed(model, hinge, kSlowMmPerS), pose};
  PushState state = table.Step({});
  EXPECT_NEAR(state.went_mm, 5.0, kPushRoundingMm) << "its farthest point no faster than it may";
  for (int i = 0; i < 12; ++i) state = table.Step(state);
  EXPECT_FALSE(table.Touches(state));
  EXPECT_NEAR((state.rest_from_part * Vector3d::Zero()).norm(), 0.0, kPushRoundingMm) << "the hinge holds";
  const Eigen::AngleAxisd turn(state.rest_from_part.rotation);
  EXPECT_GT(-turn.angle() * turn.axis().z(), 10.0 / 120.0);
  EXPECT_LT(-turn.angle() * turn.axis().z(), 25.0 / 120.0);
}

TEST(PushedPart, NeverGoesThroughAnother) {
  const SurfaceModel model = BoxModel({40.0, 20.0, 20.0}), wall = BoxModel({0.01, 100.0, 100.0});
  const Table table{model,
                    Pushed(model, kSlider, kFastMmPerS),
                    At(32.0, -10.0, -10.0),
                    {{&wall, At(80.0, -50.0, -50.0)}}};  // 8 mm of room
  PushState state;
  for (int i = 0; i < 5; ++i) {
    state = table.Step(state);
    ASSERT_LT(state.rest_from_part.translation_mm.x(), 8.0);
  }
  EXPECT_GT(state.rest_from_part.translation_mm.x(), 7.8);
  EXPECT_TRUE(state.is_blocked);
  EXPECT_TRUE(table.Touches(state));
}

TEST(PushedPart, StaysWhereNothingTouches) {
  const SurfaceModel model = BoxModel({40.0, 20.0, 20.0});
  const Table table{model, Pushed(model, kSlider, kSlowMmPerS), At(60.0, 0.0, 0.0)};
  const PushState state = table.Step({});
  EXPECT_EQ(state.rest_from_part, core::RigidTransform());
  EXPECT_FALSE(state.is_blocked);
  EXPECT_THROW((void)table.Step({}, 2.0), core::PreconditionError);
}

}  // namespace
}  // namespace elbowroom::review
