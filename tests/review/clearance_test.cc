// Clearance bounds against pairs of points: whatever hull point is found by other means is no nearer than
// `lower`, and the witnesses show `upper`.
#include "review/clearance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "core/error.h"
#include "core/infinity.h"
#include "core/part_distance.h"
#include "recon/hull/visual_hull.h"
#include "recon/hull_mesh/hull_mesh.h"
#include "review/contacts.h"
#include "tests/core/solids.h"
#include "tests/recon/scenes/random_scene.h"
#include "tests/review/box_hull.h"
#include "tests/support/soak.h"

namespace elbowroom::review {
namespace {

using Eigen::Vector3d;
using recon::Random;
using recon::VisualHull;

using core::kInfinity;
constexpr double kClearanceRoundingMm = 1e-6;

core::TriangleTree TreeOf(core::TriangleMesh mesh) {
  return core::TriangleTree(std::make_shared<const core::TriangleMesh>(std::move(mesh)));
}

core::TriangleMesh BoxAround(const Vector3d& center, const Vector3d& size_mm) {
  return core::Transformed(core::testing::Box(size_mm),
                           {Eigen::Matrix3d::Identity(), center - 0.5 * size_mm});
}

// The witnesses are what they are said to be: points of hull and part, as far from each other as `upper`.
void CheckWitnesses(const VisualHull& hull, const core::TriangleTree& part,
                    const core::RigidTransform& world_from_part, const Clearance& clearance) {
  const core::ClearanceInterval& interval = clearance.interval;
  ASSERT_LE(interval.lower_mm, interval.upper_mm);
  ASSERT_EQ(clearance.has_witnesses, std::isfinite(interval.upper_mm));
  if (!clearance.has_witnesses) return;
  const Vector3d on_hull = interval.witness_hull_in_world_mm, on_part = interval.witness_part_in_world_mm;
  // A crossing found by a ray is on the surface to the last bits, to either side.
  ASSERT_NE(hull.Classify(on_hull, kClearanceRoundingMm), recon::BallAnswer::kOutside);
  ASSERT_NEAR((on_hull - on_part).norm(), interval.upper_mm, kClearanceRoundingMm);
  if (interval.upper_mm > 0.0) {
    ASSERT_LE(FindNearest(part, {.center = world_from_part.Inverse() * on_part}).distance_mm,
              kClearanceRoundingMm);
  }
}

// Hull points of the marching cubes' and of a search around the witness.
double NearestFoundMm(const VisualHull& hull, const core::TriangleTree& part,
                      const core::RigidTransform& world_from_part, const Clearance& clearance,
                      Random* random) {
  const core::RigidTransform part_from_world = world_from_part.Inverse();
  const auto distance = [&](const Vector3d& x) {
    return FindNearest(part, {.center = part_from_world * x}).distance_mm;
  };
  double nearest_mm = kInfinity;
  for (const Vector3d& vertex : recon::MeshHull(hull, 8.0).mesh.vertices_mm)
    nearest_mm = std::min(nearest_mm, distance(vertex));
  for (int i = 0; clearance.has_witnesses && i < 200; ++i) {
    const Vector3d x =
        clearance.interval.witness_hull_in_world_mm + random->LogUniform(1e-3, 10.0) * random->Direction();
    if (hull.Contains(x)) nearest_mm = std::min(nearest_mm, distance(x));
  }
  return nearest_mm;
}

core::TriangleMesh RandomSlab(Random* random) {
  core::TriangleMesh mesh =
      BoxAround(Vector3d::Zero(),
                {random->Uniform(5.0, 80.0), random->Uniform(5.0, 80.0), random->LogUniform(0.1, 40.0)});
  for (int i = 0; i < random->Whole(0, 12); ++i) {
    const Vector3d a = random->Uniform(0.0, 60.0) * random->Direction();
    const double size = random->LogUniform(0.1, 60.0), thin = i % 3 == 0 ? 1e-6 : 1.0;
    const Vector3d b = i % 5 == 0 ? a : Vector3d(a + size * random->Direction());
    const Vector3d c = a + random->Uniform(0.0, 1.0) * (b - a) + size * thin * random->Direction();
    core::Append(mesh, {{a, b, c}, {{0, 1, 2}}});
  }
  return mesh;
}

TEST(FindClearance, BoundsAreNeverWrong) {
  Random random(7201);
  const int trials = 150 * test_support::SoakScale();
  int apart = 0, touching = 0, undecided = 0;
  for (int trial = 0; trial < trials; ++trial) {
    SCOPED_TRACE(trial);
    const auto unseen = trial % 3 == 0 ? core::UnseenPolicy::kAbstain : core::UnseenPolicy::kOutside;
    const recon::RandomScene scene = MakeRingScene(&random, random.Whole(2, 5), unseen);
    const VisualHull hull = recon::MakeVisualHull(scene.rig, scene.masks);
    const core::TriangleTree part = TreeOf(RandomSlab(&random));
    const core::RigidTransform world_from_part{random.Rotation(),
                                               random.Uniform(0.0, 250.0) * random.Direction()};
    ClearanceOptions options;
    options.tolerance_mm = random.LogUniform(0.2, 10.0);
    std::optional<ClearanceHint> hint;
    if (random.Chance(0.5))
      hint = ClearanceHint{10.0 * random.Direction(), random.Uniform(0.0, 100.0) * random.Direction()};
    const Clearance clearance = FindClearance(hull, part, world_from_part, options, hint);
    ASSERT_NO_FATAL_FAILURE(CheckWitnesses(hull, part, world_from_part, clearance));
    const core::ClearanceInterval& interval = clearance.interval;
    const double found_mm = NearestFoundMm(hull, part, world_from_part, clearance, &random);
    ASSERT_LE(interval.lower_mm, found_mm + kClearanceRoundingMm);
    const core::PartContact contact = FindContacts(hull, part, world_from_part, 0);
    if (contact.verdict == core::Verdict::kContact) {
      ASSERT_EQ(interval.lower_mm, 0.0);
      ++touching;
    }
    if (interval.upper_mm > 0.0 && std::isfinite(interval.upper_mm)) ++apart;
    if (std::isfinite(interval.lower_mm) &&
        interval.upper_mm - interval.lower_mm > options.tolerance_mm + kClearanceRoundingMm)
      ++undecided;
  }
  EXPECT_GT(apart, trials / 4);
  EXPECT_GT(touching, trials / 10);
  EXPECT_LE(undecided, trials / 20) << "hull thinner than cells, or queries that ran out";
}

TEST(FindClearance, OfABoxBesideABox) {
  for (const double gap_mm : {0.5, 3.0, 30.0}) {
    const core::TriangleTree part = TreeOf(BoxAround({65.0 + gap_mm, 3.0, -2.0}, {30.0, 25.0, 40.0}));
    ClearanceOptions options;
    options.tolerance_mm = 0.1;
    const Clearance clearance = FindClearance(BoxHull(), part, {}, options);
    EXPECT_LE(clearance.interval.lower_mm, gap_mm + kBoxHullMm);
    EXPECT_GE(clearance.interval.upper_mm, gap_mm - kBoxHullMm);
    EXPECT_LE(clearance.interval.upper_mm - clearance.interval.lower_mm, options.tolerance_mm);
    CheckWitnesses(BoxHull(), part, {}, clearance);
  }
}

TEST(FindClearance, IsNothingWhereTheyMeet) {
  const VisualHull hull = BoxHull();
  const auto upper = [&](const core::TriangleMesh& mesh) {
    const Clearance clearance = FindClearance(hull, TreeOf(mesh), {});
    EXPECT_EQ(clearance.interval.lower_mm, 0.0);
    return clearance.interval.upper_mm;
  };
  EXPECT_EQ(upper(BoxAround({60.0, 0.0, 0.0}, {40.0, 10.0, 10.0})), 0.0) << "across a face";
  EXPECT_EQ(upper(BoxAround({5.0, 0.0, 0.0}, {10.0, 10.0, 10.0})), 0.0) << "the part in the hull";
  EXPECT_EQ(upper(BoxAround(Vector3d::Zero(), {180.0, 180.0, 180.0})), 0.0) << "the hull in the part";
}

TEST(FindClearance, OfNothing) {
  const core::TriangleTree part = TreeOf(BoxAround({70.0, 0.0, 0.0}, {10.0, 10.0, 10.0}));
  EXPECT_EQ(FindClearance(BoxHull(true), part, {}).interval.lower_mm, kInfinity);
  EXPECT_EQ(FindClearance(BoxHull(), TreeOf({}), {}).interval.lower_mm, kInfinity);
}

TEST(FindClearance, WhatIsFarEnoughCostsOneQuery) {
  const core::TriangleTree part = TreeOf(BoxAround({85.0, 0.0, 0.0}, {5.0, 5.0, 5.0}));
  ClearanceOptions options;
  options.enough_mm = 20.0;
  const Clearance clearance = FindClearance(BoxHull(), part, {}, options);
  EXPECT_EQ(clearance.queries, 1);
  EXPECT_EQ(clearance.distances, 0);
  EXPECT_EQ(clearance.interval.lower_mm, 20.0);
  EXPECT_EQ(Judge(clearance, 20.0, 0.0), core::Verdict::kClear);
  options.enough_mm = 60.0;
  EXPECT_GT(FindClearance(BoxHull(), part, {}, options).queries, 1);
}

TEST(FindClearance, StaysTrueWhenItsQueriesRunOut) {
  const core::TriangleTree part = TreeOf(BoxAround({80.0, 0.0, 0.0}, {20.0, 20.0, 20.0}));
  ClearanceOptions options;
  options.tolerance_mm = 0.01;
  double last_mm = kInfinity;
  for (const std::int64_t most : {10, 100, 1000, 10'000}) {
    options.max_queries = most;
    const core::ClearanceInterval interval = FindClearance(BoxHull(), part, {}, options).interval;
    EXPECT_LE(interval.lower_mm, 20.0 + kBoxHullMm);
    EXPECT_GE(interval.upper_mm, 20.0 - kBoxHullMm);
    EXPECT_LE(interval.upper_mm - interval.lower_mm, last_mm);
    last_mm = interval.upper_mm - interval.lower_mm;
  }
}

// Eight faces cut in four, corners on the ball; the deviation is that of the plane farthest from it.
core::TriangleMesh TessellatedBall(double radius_mm) {
  core::TriangleMesh ball;
  const auto add = [&](const Vector3d& a, const Vector3d& b, const Vector3d& c) {
    const auto first = static_cast<std::int32_t>(ball.vertices_mm.size());
    for (const Vector3d& corner : {a, b, c}) ball.vertices_mm.push_back(radius_mm * corner.normalized());
    ball.triangles.push_back({first, first + 1, first + 2});
    const Vector3d* corner = &ball.vertices_mm[static_cast<std::size_t>(first)];
    const Vector3d normal = (corner[1] - corner[0]).cross(corner[2] - corner[0]).normalized();
    ball.deviation_mm = std::max(ball.deviation_mm, radius_mm - std::abs(normal.dot(corner[0])));
  };
  for (int octant = 0; octant < 8; ++octant) {
    const Vector3d x((octant & 1) != 0 ? -1.0 : 1.0, 0.0, 0.0), y(0.0, (octant & 2) != 0 ? -1.0 : 1.0, 0.0),
        z(0.0, 0.0, (octant & 4) != 0 ? -1.0 : 1.0);
    add(x, x + y, z + x);
    add(y, y + z, x + y);
    add(z, z + x, y + z);
    add(x + y, y + z, z + x);
  }
  return ball;
}

// The truth is a ball's distance: that of its centre, less its radius.
TEST(FindClearance, BoundsHoldForTheSurfaceThatAMeshStandsFor) {
  constexpr double kRadiusMm = 30.0;
  Random random(7202);
  core::TriangleMesh as_if_exact = TessellatedBall(kRadiusMm);
  const double deviation_mm = std::exchange(as_if_exact.deviation_mm, 0.0);
  ASSERT_GT(deviation_mm, 1.0) << "coarse enough to matter";
  const core::TriangleTree ball = TreeOf(TessellatedBall(kRadiusMm)), mesh = TreeOf(as_if_exact);
  int missed_by_mesh = 0;
  for (int trial = 0; trial < 200; ++trial) {
    const Vector3d center = random.Uniform(75.0, 140.0) * random.Direction();
    const core::RigidTransform pose{random.Rotation(), center};
    const double outside_mm = (center.cwiseAbs() - Vector3d::Constant(50.0)).cwiseMax(0.0).norm();
    const double truth_mm = outside_mm - kRadiusMm;
    if (truth_mm < 2.0) continue;
    ClearanceOptions options;
    options.tolerance_mm = 0.1;
    const core::ClearanceInterval interval = FindClearance(BoxHull(), ball, pose, options).interval;
    EXPECT_LE(interval.lower_mm, truth_mm + kBoxHullMm);
    EXPECT_GE(interval.upper_mm, truth_mm - kBoxHullMm);
    EXPECT_LE(interval.upper_mm - interval.lower_mm,
              options.tolerance_mm + 2.0 * deviation_mm + kClearanceRoundingMm);
    if (FindClearance(BoxHull(), mesh, pose, options).interval.lower_mm > truth_mm + kBoxHullMm)
      ++missed_by_mesh;
  }
  EXPECT_GT(missed_by_mesh, 20) << "without the deviation the bounds would be wrong";
}

TEST(FindClearance, OfATessellatedPartThatMeetsTheHullOrIsFarEnough) {
  core::TriangleMesh box = BoxAround({52.0, 0.0, 0.0}, {10.0, 10.0, 10.0});
  box.deviation_mm = 0.25;
  const Clearance met = FindClearance(BoxHull(), TreeOf(box), {});
  EXPECT_TRUE(met.meets);
  EXPECT_EQ(met.interval.lower_mm, 0.0);
  EXPECT_EQ(met.interval.upper_mm, 0.25);
  EXPECT_EQ(Judge(met, 0.1, 0.0), core::Verdict::kContact);
  const core::RigidTransform away{Eigen::Matrix3d::Identity(), {23.0, 0.0, 0.0}};  // 20 mm from the hull
  const auto verdict = [&](double required_mm) {
    ClearanceOptions options;
    options.tolerance_mm = 0.01;
    options.enough_mm = required_mm;
    return Judge(FindClearance(BoxHull(), TreeOf(box), away, options), required_mm, 0.0);
  };
  EXPECT_EQ(verdict(19.7), core::Verdict::kClear);
  EXPECT_EQ(verdict(19.9), core::Verdict::kUndecided);
  EXPECT_EQ(verdict(20.1), core::Verdict::kUndecided);
  EXPECT_EQ(verdict(20.3), core::Verdict::kNear);
}

TEST(FindClearance, RefusesWhatMeansNothing) {
  const auto refused = [](const auto& spoil, const std::string& what) {
    ClearanceOptions options;
    spoil(&options);
    try {
      options.Validate();
      FAIL() << "accepted";
    } catch (const core::Error& error) {
      EXPECT_NE(std::string(error.what()).find(what), std::string::npos) << error.what();
    }
  };
  refused([](ClearanceOptions* o) { o->tolerance_mm = 0.0; }, "tolerance");
  refused([](ClearanceOptions* o) { o->tolerance_mm = kInfinity; }, "tolerance");
  refused([](ClearanceOptions* o) { o->enough_mm = std::nan(""); }, "enough");
  refused([](ClearanceOptions* o) { o->max_queries = 0; }, "query");
}

TEST(Judge, SaysOnlyWhatTheBoundsAllow) {
  const auto verdict = [](double lower, double upper, double uncertainty) {
    return Judge({.interval = {.lower_mm = lower, .upper_mm = upper}, .meets = upper == 0.0}, 10.0,
                 uncertainty);
  };
  EXPECT_EQ(verdict(0.0, 0.0, 1.0), core::Verdict::kContact);
  EXPECT_EQ(verdict(5.0, 6.0, 1.0), core::Verdict::kNear);
  EXPECT_EQ(verdict(12.0, 13.0, 1.0), core::Verdict::kClear);
  EXPECT_EQ(verdict(10.5, 11.5, 1.0), core::Verdict::kUndecided);
  EXPECT_EQ(verdict(9.5, 10.5, 0.0), core::Verdict::kUndecided);
  EXPECT_EQ(verdict(10.0, kInfinity, 0.0), core::Verdict::kClear);
}

}  // namespace
}  // namespace elbowroom::review
