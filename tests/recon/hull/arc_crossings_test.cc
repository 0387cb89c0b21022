#include "recon/hull/arc_crossings.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/error.h"
#include "recon/hull/visual_hull.h"
#include "tests/recon/scenes/random_scene.h"

namespace elbowroom::recon {
namespace {

using Eigen::Vector3d;

// Labels of the point query and crossings are told apart by rounding alone this near to a crossing.
constexpr double kArcRoundingMm = 1e-5;
constexpr double kArcMarchMm = 0.05;

Arc RandomArc(Random* random, const Vector3d& start_in_world, double radius_mm) {
  const Vector3d arm = random->Direction();
  const Vector3d quarter = arm.cross(random->Direction()).normalized();
  return {start_in_world - radius_mm * arm, radius_mm * arm, radius_mm * quarter};
}

// The first step that is outside, if one is.
std::optional<double> MarchedExit(const VisualHull& hull, const Arc& arc) {
  const double step_rad = kArcMarchMm / arc.start_in_world.norm();
  for (double angle_rad = step_rad; angle_rad < 2.0 * std::numbers::pi; angle_rad += step_rad)
    if (!hull.Contains(arc.At(angle_rad))) return angle_rad;
  return std::nullopt;
}

void ExpectExit(const VisualHull& hull, const Arc& arc) {
  const std::optional<ArcExit> exit = FirstOutside(hull, arc);
  const std::optional<double> marched_rad = MarchedExit(hull, arc);
  ASSERT_TRUE(exit || !marched_rad) << "a marched exit can't be missed";
  if (!exit) return;
  const double rounding_rad = kArcRoundingMm / arc.start_in_world.norm();
  EXPECT_LE(exit->angle_rad, marched_rad.value_or(HUGE_VAL) + rounding_rad);
  EXPECT_FALSE(hull.Contains(arc.At(exit->angle_rad + rounding_rad)));
  constexpr int kSamples = 200;
  for (int i = 1; i < kSamples; ++i) {
    const double angle_rad = (exit->angle_rad - rounding_rad) * i / kSamples;
    EXPECT_TRUE(angle_rad <= 0.0 || hull.Contains(arc.At(angle_rad))) << i;
  }
}

TEST(ArcCrossings, AgreeWithAMarchAroundTheCircle) {
  Random random(7301);
  int arcs = 0;
  for (int trial = 0; trial < 60; ++trial) {
    const auto unseen = trial % 2 == 0 ? core::UnseenPolicy::kOutside : core::UnseenPolicy::kAbstain;
    const RandomScene scene = MakeRingScene(&random, random.Whole(1, 5), unseen);
    const VisualHull hull = MakeVisualHull(scene.rig, scene.masks);
    for (int i = 0; i < 60; ++i) {
      const Vector3d start = random.PointIn(hull.rig().workspace_mm);
      if (!hull.Contains(start)) continue;
      ++arcs;
      ExpectExit(hull, RandomArc(&random, start, random.LogUniform(0.5, 300.0)));
    }
  }
  EXPECT_GT(arcs, 150);
}

TEST(ArcCrossings, BeginOutsideAtOnce) {
  Random random(7302);
  const RandomScene scene = MakeRingScene(&random, 3, core::UnseenPolicy::kOutside);
  const VisualHull hull = MakeVisualHull(scene.rig, scene.masks);
  const auto exit = FirstOutside(hull, RandomArc(&random, Vector3d(1e5, 0, 0), 10.0));
  ASSERT_TRUE(exit);
  EXPECT_EQ(exit->angle_rad, 0.0);
}

TEST(ArcCrossings, RefuseWhatIsNoCircle) {
  Random random(7303);
  const RandomScene scene = MakeRingScene(&random, 2, core::UnseenPolicy::kOutside);
  const VisualHull hull = MakeVisualHull(scene.rig, scene.masks);
  const Vector3d x = Vector3d::UnitX(), y = Vector3d::UnitY();
  for (const Arc& arc : {Arc{x, Vector3d::Zero(), Vector3d::Zero()}, Arc{x, x, 2.0 * y}, Arc{x, x, x}})
    EXPECT_THROW((void)FirstOutside(hull, arc), core::PreconditionError);
}

}  // namespace
}  // namespace elbowroom::recon
