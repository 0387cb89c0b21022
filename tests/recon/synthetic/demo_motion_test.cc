// The demo's motion is smooth, tells the paper's story, and repeats.
#include "recon/synthetic/demo_motion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <set>
#include <string>

#include "core/error.h"
#include "recon/synthetic/actors.h"

namespace elbowroom::recon {
namespace {

using Eigen::Vector3d;

const SyntheticObject* Find(const DemoScene& scene, const std::string& name) {
  const auto found = std::ranges::find(scene.objects, name, &SyntheticObject::name);
  return found == scene.objects.end() ? nullptr : &*found;
}

TEST(DemoMotion, NothingMovesFasterThanAHand) {
  constexpr double kStepS = 0.01;
  constexpr double kFastestMmPerS = 1200.0;  // an unhurried reach; a jump of 12 mm in a step would show
  for (double time_s = 0.0; time_s + kStepS < kTaskSeconds; time_s += kStepS) {
    const DemoScene before = DemoSceneAt(time_s);
    const DemoScene after = DemoSceneAt(time_s + kStepS);
    if (before.tongs_in_use != after.tongs_in_use) continue;  // the hand fetches the tongs out of sight
    for (std::size_t i = 0; i < before.objects.size(); ++i) {
      const auto& solids_before = before.objects[i].solids;
      const auto& solids_after = after.objects[i].solids;
      ASSERT_EQ(solids_before.size(), solids_after.size());
      for (std::size_t k = 0; k < solids_before.size(); ++k) {
        const double moved_mm = (BoundingSphereOf(solids_after[k]).center_in_world -
                                 BoundingSphereOf(solids_before[k]).center_in_world)
                                    .norm();
        ASSERT_LE(moved_mm, kFastestMmPerS * kStepS) << before.objects[i].name << " at " << time_s << " s";
      }
    }
  }
}

TEST(DemoMotion, ThePipeIsStoodUpAndEndsInTheReceptacle) {
  const auto pipe_at = [](double time_s) {
    return Find(DemoSceneAt(time_s), "pipe")->solids[0].world_from_solid;
  };
  EXPECT_LT(pipe_at(0.5).rotation(2, 2), 0.8) << "brought tilted";
  for (const double time_s : {6.0, 9.0, 13.0, 15.9}) {
    EXPECT_NEAR(pipe_at(time_s).rotation(2, 2), 1.0, 1e-9);
    EXPECT_NEAR((pipe_at(time_s).translation_mm - Vector3d(0.0, 0.0, kPipeStandsAtZMm)).norm(), 0.0, 1e-9);
  }
}

TEST(DemoMotion, TheHandHoldsWhatItCarries) {
  constexpr double kGripGapMm = 3.0;    // as good as touching at the cameras' 2 mm a pixel
  constexpr double kGripDepthMm = 9.0;  // rigid capsules stand for soft finger pads
  for (const double time_s : {0.5, 2.0, 3.5, 5.0}) {
    const DemoScene scene = DemoSceneAt(time_s);
    const Solid& pipe = Find(scene, "pipe")->solids[0];
    double nearest_mm = std::numeric_limits<double>::infinity();
    for (const Solid& bone : Find(scene, "hand")->solids) {
      const double length_mm = std::get<Capsule>(bone.shape).length_mm;
      for (double along = 0.0; along <= 1.0; along += 0.1) {
        const Vector3d on_axis = bone.world_from_solid * Vector3d(0.0, 0.0, along * length_mm);
        nearest_mm =
            std::min(nearest_mm, SignedDistanceMm(pipe, on_axis) - std::get<Capsule>(bone.shape).radius_mm);
      }
    }
    EXPECT_LT(nearest_mm, kGripGapMm) << time_s;
    EXPECT_GT(nearest_mm, -kGripDepthMm) << time_s;
  }
}

TEST(DemoMotion, ThePlugGoesDownThePipeWithTheTongs) {
  double plug_before_mm = std::numeric_limits<double>::infinity();
  for (double time_s = 10.3; time_s < kTaskSeconds; time_s += 0.05) {
    const DemoScene scene = DemoSceneAt(time_s);
    ASSERT_TRUE(scene.tongs_in_use);
    ASSERT_NE(Find(scene, "tongs"), nullptr);
    const Vector3d plug = Find(scene, "cable")->solids[0].world_from_solid.translation_mm;
    ASSERT_LE(plug.z(), plug_before_mm + 1e-9) << "never pulled back";
    ASSERT_LT(plug.head<2>().norm() + kPlugRadiusMm, kPipeRadiusMm - kPipeWallMm) << "inside the bore";
    plug_before_mm = plug.z();
  }
  EXPECT_NEAR(plug_before_mm, kPlugEndsAtZMm, 1e-9);
}

TEST(DemoMotion, GoesThroughItsPhasesAndRepeats) {
  std::set<std::string> phases;
  for (double time_s = 0.0; time_s < kTaskSeconds; time_s += 0.1) {
    phases.emplace(ToString(DemoSceneAt(time_s).phase));
    EXPECT_EQ(DemoSceneAt(time_s).tongs_in_use, Find(DemoSceneAt(time_s), "tongs") != nullptr);
  }
  EXPECT_EQ(phases.size(), 6U);
  const DemoScene once = DemoSceneAt(5.0);
  const DemoScene again = DemoSceneAt(5.0 + 2.0 * kTaskSeconds);
  EXPECT_NEAR((once.objects[0].solids[0].world_from_solid.translation_mm -
               again.objects[0].solids[0].world_from_solid.translation_mm)
                  .norm(),
              0.0, 1e-9);
  EXPECT_THROW((void)DemoSceneAt(-0.1), core::PreconditionError);
}

TEST(PayloadManner, DecidesWhoStandsWhereWithWhichHand) {
  const PayloadManner demo;
  PayloadManner other;
  other.hand_size = 0.9;
  other.from_rad = 0.3;
  other.takes_tongs = false;
  other.strokes = 3;
  other.Validate();
  for (const double time_s : {2.0, 6.5, 11.0}) {
    const DemoScene scene = PayloadSceneAt(other, time_s);
    EXPECT_EQ(scene.phase, PayloadSceneAt(demo, time_s).phase);
    EXPECT_FALSE(scene.tongs_in_use);
    EXPECT_EQ(Find(scene, "tongs"), nullptr);
    const auto& hand = Find(scene, "hand")->solids;
    EXPECT_NEAR(std::get<Capsule>(hand.front().shape).radius_mm,
                0.9 * std::get<Capsule>(Find(DemoSceneAt(time_s), "hand")->solids.front().shape).radius_mm,
                1e-12);
  }
  // Turned about the receptacle, the pipe still ends in it, and the plug at the outlet.
  const DemoScene end = PayloadSceneAt(other, kTaskSeconds);
  EXPECT_NEAR((Find(end, "pipe")->solids[0].world_from_solid * Vector3d(0.0, 0.0, 0.0) -
               Vector3d(0.0, 0.0, kPipeStandsAtZMm))
                  .norm(),
              0.0, 1e-9);
  EXPECT_NEAR(Find(end, "cable")->solids[0].world_from_solid.translation_mm.z(), kPlugEndsAtZMm, 1e-9);
  other.strokes = 0;
  EXPECT_THROW(other.Validate(), core::PreconditionError);
}

}  // namespace
}  // namespace elbowroom::recon
