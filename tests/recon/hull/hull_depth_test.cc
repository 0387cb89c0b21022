#include "recon/hull/hull_depth.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "recon/hull/ray_crossings.h"
#include "recon/hull/visual_hull.h"
#include "tests/recon/scenes/random_scene.h"

namespace elbowroom::recon {
namespace {

using Eigen::Vector3d;

// Of crossings, labels, and the share by which depths are short, for lengths up to a metre.
constexpr double kDepthRoundingMm = 1e-5;

double NearestExitMm(const VisualHull& hull, const Vector3d& x, const Vector3d& direction) {
  return FirstOutside(hull, Ray{x, direction}).value();
}

TEST(HullDepth, IsWhereTheNearestRayLeaves) {
  Random random(7401);
  int points = 0, farther = 0;
  for (int trial = 0; trial < 80; ++trial) {
    const auto unseen = trial % 2 == 0 ? core::UnseenPolicy::kOutside : core::UnseenPolicy::kAbstain;
    const RandomScene scene = MakeRingScene(&random, random.Whole(1, 5), unseen);
    const VisualHull hull = MakeVisualHull(scene.rig, scene.masks);
    for (int i = 0; i < 40; ++i) {
      const Vector3d x = random.PointIn(hull.rig().workspace_mm);
      const std::optional<HullDepth> depth = DepthAt(hull, x);
      ASSERT_EQ(depth.has_value(), hull.Contains(x));
      if (!depth) continue;
      ++points;
      const double probed_mm = hull.Probe(x).radius_mm;
      EXPECT_GE(depth->depth_mm, probed_mm - kDepthRoundingMm);
      farther += depth->depth_mm > 1.1 * probed_mm ? 1 : 0;
      EXPECT_NEAR((depth->nearest_in_world - x).norm(), depth->depth_mm, kDepthRoundingMm);
      for (int ray = 0; ray < 60; ++ray)
        ASSERT_LE(depth->depth_mm, NearestExitMm(hull, x, random.Direction()) + kDepthRoundingMm);
      // Under `abstain` another camera may see on.
      if (depth->depth_mm < kDepthRoundingMm || unseen == core::UnseenPolicy::kAbstain) continue;
      const Vector3d way = (depth->nearest_in_world - x).normalized();
      EXPECT_NEAR(NearestExitMm(hull, x, way), depth->depth_mm, kDepthRoundingMm) << trial;
    }
  }
  EXPECT_GT(points, 200);
  EXPECT_GT(farther, points / 3) << "most points are deeper than Probe() looks";
}

TEST(HullDepth, NamesTheCameraOrAFace) {
  Random random(7402);
  int faces = 0, cameras = 0;
  const RandomScene scene = MakeRingScene(&random, 3, core::UnseenPolicy::kOutside);
  const VisualHull hull = MakeVisualHull(scene.rig, scene.masks);
  for (int i = 0; i < 2000; ++i) {
    const Vector3d x = random.PointIn(hull.rig().workspace_mm);
    const std::optional<HullDepth> depth = DepthAt(hull, x);
    if (!depth) continue;
    (depth->camera ? cameras : faces) += 1;
    const Eigen::AlignedBox3d& box = hull.rig().workspace_mm;
    const double to_face_mm = std::min((x - box.min()).minCoeff(), (box.max() - x).minCoeff());
    if (depth->camera) {
      EXPECT_LE(depth->depth_mm, to_face_mm);
    } else {
      EXPECT_NEAR(depth->depth_mm, to_face_mm, kDepthRoundingMm);
    }
  }
  EXPECT_GT(cameras, 50);
}

}  // namespace
}  // namespace elbowroom::recon
