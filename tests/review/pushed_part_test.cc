// Rigid parts that are pushed, against a hull whose faces are known and parts that stand in the way.
#include "review/pushed_part.h"

#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "core/error.h"
#include "review/contacts.h"
#include "tests/core/solids.h"
#include "tests/review/box_hull.h"

namespace elbowroom::review {
namespace {

using Eigen::Vector3d;

constexpr double kFrameS = 1.0 / 30.0;
constexpr double kRoundingMm = 1e-6;

SurfaceModel BoxModel(const Vector3d& size_mm) {
  return SurfaceModel(std::make_shared<const core::TriangleMesh>(core::testing::Box(size_mm)));
}

core::RigidTransform At(double x_mm, double y_mm, double z_mm) {
  return {Eigen::Matrix3d::Identity(), Vector3d(x_mm, y_mm, z_mm)};
}

const core::PushRule kSlider{.v_rec = Vector3d::UnitX(), .max_speed_mm_per_s = 150.0};

bool Touches(const SurfaceModel& model, core::RigidTransform pose, const PushState& state,
             const recon::VisualHull& hull) {
  pose.translation_mm += state.moved_in_world;
  return FindContacts(hull, model.tree(), pose, 0).verdict == core::Verdict::kContact;
}

TEST(PushedPart, LeavesTheHullAlongItsSliderNoFasterThanItMay) {
  const recon::VisualHull hull = BoxHull();  // [-50, 50]^3
  const SurfaceModel model = BoxModel({40.0, 20.0, 20.0});
  const core::RigidTransform pose = At(32.0, -10.0, -10.0);  // 18 mm in: the short way is +x
  PushState state;
  state = StepPush(kSlider, state, {&model, pose}, {}, hull, kFrameS);
  EXPECT_NEAR(state.went_mm, 5.0, kRoundingMm);  // 150 mm/s for 1/30 s
  EXPECT_GT(state.wanted_mm, 17.0);
  EXPECT_LT(state.wanted_mm, 19.0);
  for (int i = 0; i < 5; ++i) state = StepPush(kSlider, state, {&model, pose}, {}, hull, kFrameS);
  EXPECT_FALSE(Touches(model, pose, state, hull));
  EXPECT_NEAR(state.moved_in_world.x(), 18.5, 0.5);
  EXPECT_EQ(state.moved_in_world.y(), 0.0);
  const PushState rests = StepPush(kSlider, state, {&model, pose}, {}, hull, kFrameS);
  EXPECT_EQ(rests.moved_in_world, state.moved_in_world);
}

TEST(PushedPart, WithoutASliderItGoesTowardsItsReference) {
  const recon::VisualHull hull = BoxHull();
  const SurfaceModel model = BoxModel({60.0, 20.0, 20.0});
  const core::RigidTransform pose = At(40.0, -10.0, -10.0);
  PushState state;
  const core::PushRule rule{.v_rec = {}, .max_speed_mm_per_s = 1000.0};
  for (int i = 0; i < 8; ++i) state = StepPush(rule, state, {&model, pose}, {}, hull, kFrameS);
  EXPECT_FALSE(Touches(model, pose, state, hull));
  EXPECT_GT(state.moved_in_world.x(), 5.0);
}

TEST(PushedPart, NeverGoesThroughAnother) {
  const recon::VisualHull hull = BoxHull();
  const SurfaceModel model = BoxModel({40.0, 20.0, 20.0}), wall = BoxModel({0.01, 100.0, 100.0});
  const core::RigidTransform pose = At(32.0, -10.0, -10.0);
  const core::PushRule fast{.v_rec = Vector3d::UnitX(), .max_speed_mm_per_s = 10000.0};
  const std::vector<StandingPart> others{{&wall, At(80.0, -50.0, -50.0)}};  // 8 mm of room
  PushState state;
  for (int i = 0; i < 5; ++i) {
    state = StepPush(fast, state, {&model, pose}, others, hull, kFrameS);
    ASSERT_LT(state.moved_in_world.x(), 8.0);
  }
  EXPECT_GT(state.moved_in_world.x(), 7.8);
  EXPECT_TRUE(state.is_blocked);
  EXPECT_TRUE(Touches(model, pose, state, hull));
}

TEST(PushedPart, StaysWhereNothingTouches) {
  const SurfaceModel model = BoxModel({40.0, 20.0, 20.0});
  const PushState state = StepPush(kSlider, {}, {&model, At(60.0, 0.0, 0.0)}, {}, BoxHull(), kFrameS);
  EXPECT_EQ(state.moved_in_world, Vector3d::Zero());
  EXPECT_FALSE(state.is_blocked);
  EXPECT_THROW((void)StepPush(kSlider, {}, {&model, At(60.0, 0.0, 0.0)}, {}, BoxHull(), 2.0),
               core::PreconditionError);
}

}  // namespace
}  // namespace elbowroom::review
