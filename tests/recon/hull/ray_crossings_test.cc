#include "recon/hull/ray_crossings.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "core/error.h"
#include "recon/contours/silhouette.h"
#include "recon/hull/visual_hull.h"
#include "tests/recon/scenes/random_scene.h"

namespace elbowroom::recon {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kRayMarchMm = 0.02;
// Rounding of points about a metre from the origin, and of crossings of edges met at a slope of 1 : 1000.
constexpr double kRayRoundingMm = 1e-7;
constexpr double kFarMm = 700.0;

Vector3d PointOn(const Ray& ray, double t_mm) { return ray.origin_in_world + t_mm * ray.direction_in_world; }

Ray RandomRay(Random* random, const core::Rig& rig) {
  const Vector3d origin = random->Uniform(0.1, 2.0) * random->PointIn(rig.workspace_mm);
  const Vector3d target = 0.3 * random->PointIn(rig.workspace_mm);
  return {origin, (target - origin).normalized()};
}

bool IsIn(const std::vector<HullInterval>& intervals, double t_mm) {
  return std::ranges::any_of(intervals,
                             [&](const HullInterval& i) { return i.from_mm <= t_mm && t_mm <= i.to_mm; });
}

double DistanceToAnEnd(const std::vector<HullInterval>& intervals, double t_mm) {
  double nearest_mm = kFarMm;
  for (const HullInterval& i : intervals)
    nearest_mm = std::min({nearest_mm, std::abs(i.from_mm - t_mm), std::abs(i.to_mm - t_mm)});
  return nearest_mm;
}

// Every step of a march agrees, but within rounding of an end.
void ExpectAgreesWithAMarch(const VisualHull& hull, const Ray& ray, double step_mm, int* inside) {
  const std::vector<HullInterval> intervals = IntervalsInHull(hull, ray);
  for (double t_mm = 0.0; t_mm < kFarMm; t_mm += step_mm) {
    const bool contains = hull.Contains(PointOn(ray, t_mm));
    *inside += contains ? 1 : 0;
    if (contains != IsIn(intervals, t_mm)) {
      ASSERT_LE(DistanceToAnEnd(intervals, t_mm), kRayRoundingMm) << t_mm;
    }
  }
}

// Intervals are ordered, apart, and end where Contains() changes.
void ExpectEndsAreCrossings(const VisualHull& hull, const Ray& ray,
                            const std::vector<HullInterval>& intervals) {
  double last_mm = 0.0;
  for (const HullInterval& interval : intervals) {
    ASSERT_LT(interval.from_mm, interval.to_mm);
    ASSERT_GE(interval.from_mm, last_mm);
    last_mm = interval.to_mm;
    if (interval.to_mm - interval.from_mm < 4.0 * kRayRoundingMm) continue;
    ASSERT_TRUE(hull.Contains(PointOn(ray, interval.from_mm + kRayRoundingMm)));
    ASSERT_TRUE(hull.Contains(PointOn(ray, interval.to_mm - kRayRoundingMm)));
  }
}

// The boundary named at an end is there: in the plane of a camera, on the edge named.
void ExpectOnEdge(const VisualHull& hull, const HullBoundary& boundary, const Vector3d& x_in_world) {
  if (!boundary.camera) return;
  const Silhouette& silhouette = *hull.silhouettes()[*boundary.camera];
  const Vector3d x_in_cam = hull.rig().cameras[*boundary.camera].cam_from_world() * x_in_world;
  const Vector2d position = x_in_cam.head<2>() * (silhouette.plane().focal_px() / x_in_cam.z());
  const Contour& contour =
      boundary.is_outline ? silhouette.plane().outline().contour() : silhouette.labels().contour();
  constexpr double kOnEdgePx = 1e-6;
  ASSERT_LE(DistanceToEdge(contour, boundary.edge, position), kOnEdgePx * (1.0 + position.norm()));
}

TEST(IntervalsInHull, AgreeWithAMarchOfContainsUnderBothPolicies) {
  Random random(5301);
  int inside = 0, intervals_seen = 0;
  for (const auto unseen : {core::UnseenPolicy::kOutside, core::UnseenPolicy::kAbstain}) {
    for (int trial = 0; trial < 12; ++trial) {
      const RandomScene scene = MakeRingScene(&random, random.Whole(1, 5), unseen);
      const VisualHull hull = MakeVisualHull(scene.rig, scene.masks);
      for (int i = 0; i < 3; ++i) {
        const Ray ray = RandomRay(&random, *scene.rig);
        ExpectAgreesWithAMarch(hull, ray, kRayMarchMm, &inside);
        const std::vector<HullInterval> intervals = IntervalsInHull(hull, ray);
        intervals_seen += static_cast<int>(intervals.size());
        ExpectEndsAreCrossings(hull, ray, intervals);
        for (const HullInterval& interval : intervals) {
          ExpectOnEdge(hull, interval.entry, PointOn(ray, interval.from_mm));
          ExpectOnEdge(hull, interval.exit, PointOn(ray, interval.to_mm));
        }
        if (HasFatalFailure()) FAIL() << "trial " << trial << " ray " << i;
      }
    }
  }
  EXPECT_GT(inside, 20'000);
  EXPECT_GT(intervals_seen, 30);
}

// Noise, stripes, holes, cameras in the middle of things, focal lengths of 50 to 50,000 px: a coarse march.
TEST(IntervalsInHull, AgreeWithAMarchInEveryKindOfScene) {
  Random random(5302);
  int inside = 0;
  for (int trial = 0; trial < 120; ++trial) {
    const RandomScene scene = MakeRandomScene(&random);
    const VisualHull hull = MakeVisualHull(scene.rig, scene.masks);
    for (int i = 0; i < 6; ++i) {
      const Ray ray = RandomRay(&random, *scene.rig);
      ExpectAgreesWithAMarch(hull, ray, 0.97, &inside);
      ExpectEndsAreCrossings(hull, ray, IntervalsInHull(hull, ray));
      if (HasFatalFailure()) FAIL() << "trial " << trial << " ray " << i;
    }
  }
  EXPECT_GT(inside, 2500);
}

TEST(IntervalsInHull, OfRaysThroughCameraCentres) {
  Random random(5303);
  int inside = 0;
  for (int trial = 0; trial < 10; ++trial) {
    const RandomScene scene = MakeRingScene(&random, 3, core::UnseenPolicy::kAbstain);
    core::Rig rig = *scene.rig;
    rig.workspace_mm = {Vector3d::Constant(-1200), Vector3d::Constant(1200)};  // the centres are in it
    const VisualHull hull = MakeVisualHull(std::make_shared<const core::Rig>(rig), scene.masks);
    for (const core::CameraModel& camera : rig.cameras) {
      for (const double before_mm : {50.0, 0.0, 1e-9, -1e-9, -30.0}) {
        const Vector3d target = 0.3 * random.PointIn(scene.rig->workspace_mm);
        const Vector3d direction = (target - camera.center_in_world()).normalized();
        const Ray ray{camera.center_in_world() - before_mm * direction, direction};
        ExpectAgreesWithAMarch(hull, ray, 0.11, &inside);
        if (HasFatalFailure()) FAIL() << "trial " << trial << " from " << before_mm;
      }
    }
  }
  EXPECT_GT(inside, 1000);
}

// A ray that starts where another has just met the surface: the label of its origin is rounding's.
TEST(IntervalsInHull, StartOnTheSurface) {
  Random random(5304);
  int asked = 0;
  for (int trial = 0; trial < 40; ++trial) {
    const RandomScene scene = MakeRingScene(&random, 3, core::UnseenPolicy::kOutside);
    const VisualHull hull = MakeVisualHull(scene.rig, scene.masks);
    for (int i = 0; i < 30; ++i) {
      const Ray ray = RandomRay(&random, *scene.rig);
      const std::vector<HullInterval> intervals = IntervalsInHull(hull, ray);
      if (intervals.empty() || intervals.front().from_mm == 0.0) continue;
      ++asked;
      const double at_mm = intervals.front().from_mm;
      const Ray onwards{PointOn(ray, at_mm), ray.direction_in_world};
      const Ray back{PointOn(ray, at_mm), -ray.direction_in_world};
      ASSERT_NEAR(FirstInside(hull, onwards).value_or(-1.0), 0.0, kRayRoundingMm);
      // Nothing of the hull is between the first ray's start and its first crossing.
      for (const HullInterval& interval : IntervalsInHull(hull, back, {0.0, at_mm}))
        ASSERT_LE(interval.to_mm, kRayRoundingMm) << "trial " << trial << " ray " << i;
    }
  }
  EXPECT_GT(asked, 300);
}

TEST(IntervalsInHull, OfRaysAlongFacesAndBorders) {
  // One camera above a box, all object: the hull is its view pyramid in the box, all of round numbers.
  core::Rig rig;
  rig.workspace_mm = {Vector3d(-100, -100, 0), Vector3d(100, 100, 50)};
  core::CameraCalibration c;
  c.image_width_px = c.image_height_px = 8;
  c.camera_matrix << 64.0, 0.0, 3.5, 0.0, 64.0, 3.5, 0.0, 0.0, 1.0;
  c.cam_from_world.translation_mm.z() = 640.0;  // looking up from z = -640
  rig.cameras.emplace_back(c);
  core::BitMask mask(8, 8);
  for (int i = 0; i < 64; ++i) mask.Set(i % 8, i / 8, true);
  const VisualHull hull = MakeVisualHull(std::make_shared<const core::Rig>(rig), std::array{mask});
  constexpr double kHalfMm = 4.0 * 640.0 / 64.0;  // of the pyramid at z = 0
  // In a face of the workspace, which belongs to the hull.
  const auto along_face = IntervalsInHull(hull, {{-200, 0, 0}, Vector3d::UnitX()});
  ASSERT_EQ(along_face.size(), 1U);
  EXPECT_NEAR(along_face[0].from_mm, 200.0 - kHalfMm, 1e-9);
  EXPECT_NEAR(along_face[0].to_mm, 200.0 + kHalfMm, 1e-9);
  EXPECT_TRUE(IntervalsInHull(hull, {{-200, 0, -1e-9}, Vector3d::UnitX()}).empty());
  // Parallel to the axis: through the pyramid's side, which opens upwards.
  const auto upwards = IntervalsInHull(hull, {{kHalfMm + 1.0, 0, -10}, Vector3d::UnitZ()});
  ASSERT_EQ(upwards.size(), 1U);
  EXPECT_NEAR(upwards[0].from_mm, 10.0 + 16.0, 1e-9);
  EXPECT_EQ(upwards[0].entry.camera, std::optional<core::CameraIndex>(0));
  EXPECT_EQ(upwards[0].to_mm, 60.0);
  EXPECT_FALSE(upwards[0].exit.camera.has_value()) << "a face";
  // Along the picture's border itself, a ray through the centre: either answer, but a clean one.
  const Ray along_border{{0, 0, -640}, Vector3d(kHalfMm, 0, 640).normalized()};
  for (const HullInterval& interval : IntervalsInHull(hull, along_border)) {
    EXPECT_NEAR(interval.from_mm, std::hypot(640.0, kHalfMm), 1e-6);
    EXPECT_NEAR(interval.to_mm, 690.0 / 640.0 * std::hypot(640.0, kHalfMm), 1e-6);
  }
  // A hair inside and outside of it.
  for (const double aside : {-1e-6, 1e-6}) {
    const Ray ray{{0, 0, -640}, Vector3d(kHalfMm + aside, 0, 640).normalized()};
    EXPECT_EQ(IntervalsInHull(hull, ray).size(), aside < 0.0 ? 1U : 0U);
  }
}

TEST(IntervalsInHull, LimitsSpansAndErrors) {
  Random random(5305);
  const RandomScene scene = MakeRingScene(&random, 3, core::UnseenPolicy::kOutside);
  const VisualHull hull = MakeVisualHull(scene.rig, scene.masks);
  std::optional<Ray> through;
  for (int i = 0; i < 1000 && !through; ++i) {
    const Ray ray = RandomRay(&random, *scene.rig);
    if (FirstInside(hull, ray).value_or(0.0) > 1.0) through = ray;
  }
  ASSERT_TRUE(through.has_value());
  const HullInterval whole = IntervalsInHull(hull, *through).front();
  const double hit_mm = whole.from_mm;
  EXPECT_FALSE(FirstInside(hull, *through, {0.0, hit_mm - 0.01}).has_value());
  EXPECT_EQ(FirstInside(hull, *through, {hit_mm + 1e-3}), hit_mm + 1e-3) << "a span that starts inside";
  EXPECT_EQ(FirstOutside(hull, *through, {hit_mm + 1e-3}), whole.to_mm);
  EXPECT_EQ(FirstOutside(hull, *through), 0.0) << "a span that starts outside";
  EXPECT_FALSE(FirstOutside(hull, *through, {hit_mm + 1e-3, hit_mm + 2e-3}).has_value())
      << "inside all along";
  EXPECT_FALSE(FirstInside(hull, {through->origin_in_world, -through->direction_in_world}).has_value());
  const std::vector<HullInterval> cut = IntervalsInHull(hull, *through, {hit_mm + 1e-3, hit_mm + 2e-3});
  ASSERT_EQ(cut.size(), 1U);
  EXPECT_FALSE(cut[0].entry.camera || cut[0].exit.camera) << "the ends of the search";
  EXPECT_THROW((void)IntervalsInHull(hull, {Vector3d::Zero(), {0, 0, 2}}), core::PreconditionError);
  EXPECT_THROW((void)IntervalsInHull(hull, *through, {2.0, 1.0}), core::PreconditionError);
  EXPECT_THROW((void)IntervalsInHull(hull, *through, {-1.0, 1.0}), core::PreconditionError);
}

TEST(IntervalsInHull, OfEmptyAndFullMasks) {
  Random random(5306);
  for (const auto unseen : {core::UnseenPolicy::kOutside, core::UnseenPolicy::kAbstain}) {
    RandomScene scene = MakeRingScene(&random, 2, unseen);
    for (core::BitMask& mask : scene.masks) mask = core::BitMask(160, 120);
    const Ray ray{{0, -600, 0}, Vector3d::UnitY()};
    EXPECT_TRUE(IntervalsInHull(MakeVisualHull(scene.rig, scene.masks), ray).empty());
    for (core::BitMask& mask : scene.masks)
      for (int i = 0; i < 160 * 120; ++i) mask.Set(i % 160, i / 160, true);
    const VisualHull full = MakeVisualHull(scene.rig, scene.masks);
    int inside = 0;
    ExpectAgreesWithAMarch(full, ray, 0.1, &inside);
    EXPECT_GT(inside, 500);
  }
}

}  // namespace
}  // namespace elbowroom::recon
