// The shortest way out, one direction's and any direction's, against closed forms and against brute force.
#include "review/penetration.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <vector>

#include "core/error.h"
#include "core/part_distance.h"
#include "recon/hull/visual_hull.h"
#include "review/contacts.h"
#include "review/escape_distance.h"
#include "review/hull_part_intersection.h"
#include "review/inside_cells.h"
#include "tests/core/solids.h"
#include "tests/recon/scenes/random_scene.h"
#include "tests/review/box_hull.h"
#include "tests/support/soak.h"

namespace elbowroom::review {
namespace {

using core::TriangleMesh;
using Eigen::Vector3d;
using recon::Random;
using recon::VisualHull;

constexpr double kToleranceMm = 0.5;
constexpr double kSampleMm = 2.0;
// Samples that far apart may miss what two solids share, if it is no deeper than this.
constexpr double kMissedMm = 3.0 * kSampleMm;

TriangleMesh BoxAround(const Vector3d& center, const Vector3d& sides_mm) {
  return core::Transformed(core::testing::Box(sides_mm),
                           {Eigen::Matrix3d::Identity(), center - 0.5 * sides_mm});
}
TriangleMesh CubeAround(const Vector3d& center, double side_mm) {
  return BoxAround(center, Vector3d::Constant(side_mm));
}

// An octahedron whose triangles are quartered `times` times: inscribed in the sphere.
TriangleMesh SphereAround(const Vector3d& center, double radius_mm, int times = 4) {
  TriangleMesh mesh;
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {1.0, -1.0}) mesh.vertices_mm.push_back(side * Vector3d::Unit(axis));
  mesh.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  for (int i = 0; i < times; ++i) {
    std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> middles;
    const auto middle = [&](std::int32_t a, std::int32_t b) {
      const auto [at, is_new] = middles.try_emplace(std::minmax(a, b), mesh.vertices_mm.size());
      if (is_new)
        mesh.vertices_mm.push_back(
            (mesh.vertices_mm[static_cast<std::size_t>(a)] + mesh.vertices_mm[static_cast<std::size_t>(b)])
                .normalized());
      return at->second;
    };
    std::vector<std::array<std::int32_t, 3>> quarters;
    for (const auto& [a, b, c] : mesh.triangles) {
      const std::int32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      for (const auto& t : {std::array{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}})
        quarters.push_back(t);
    }
    mesh.triangles = quarters;
  }
  for (Vector3d& vertex : mesh.vertices_mm) vertex = center + radius_mm * vertex;
  return mesh;
}

core::TriangleTree TreeOf(TriangleMesh mesh) {
  return core::TriangleTree(std::make_shared<const TriangleMesh>(std::move(mesh)));
}

Penetration PenetrationOf(const VisualHull& hull, const core::TriangleTree& part,
                          const core::RigidTransform& world_from_part = {}) {
  return FindPenetration(hull, part, world_from_part, FindContacts(hull, part, world_from_part, 0),
                         kToleranceMm);
}

void ExpectBounds(const Penetration& found, double truth_mm, double slack_mm) {
  EXPECT_LE(found.lower_mm, truth_mm + slack_mm);
  EXPECT_GE(found.upper_mm, truth_mm - slack_mm);
  EXPECT_LE(found.upper_mm - found.lower_mm, kToleranceMm + slack_mm);
  EXPECT_FALSE(found.leaves_workspace);
}

TEST(Penetration, OfABoxInABox) {
  const Penetration found = PenetrationOf(BoxHull(), TreeOf(CubeAround({45, 3, -7}, 20.0)));
  ExpectBounds(found, 15.0, kBoxHullMm);
  EXPECT_GT(found.direction_in_world.x(), 0.999);
}

TEST(Penetration, OfASphereInABox) {
  // By its centre's depth and its radius; the mesh is inscribed, so up to a share of the radius less.
  constexpr double kInscribedMm = 0.1;
  const Penetration found = PenetrationOf(BoxHull(), TreeOf(SphereAround({5, -26, 3}, 12.0)));
  ExpectBounds(found, 36.0, kInscribedMm);
  EXPECT_LT(found.direction_in_world.y(), -0.99);
}

TEST(Penetration, OfABoxTurnedInABox) {
  // A cube on its edge: out through x by its half diagonal.
  const double half_mm = 10.0 * std::sqrt(2.0);
  const core::RigidTransform world_from_part = core::FromPositionAndRollPitchYaw({40, 0, 0}, {0, 0, 45});
  const Penetration found =
      PenetrationOf(BoxHull(), TreeOf(CubeAround(Vector3d::Zero(), 20.0)), world_from_part);
  EXPECT_LE(found.lower_mm, 10.0 + half_mm + kBoxHullMm);
  EXPECT_GE(found.lower_mm, 10.0 + 10.0 - kToleranceMm) << "the ball in the cube shows no more";
  EXPECT_NEAR(found.upper_mm, 10.0 + half_mm, kToleranceMm);
}

TEST(Penetration, OfAHullWhollyInsideAPart) {
  const Penetration found = PenetrationOf(BoxHull(), TreeOf(BoxAround({10, 0, 0}, Vector3d(160, 300, 300))));
  ExpectBounds(found, 120.0, kBoxHullMm);
  EXPECT_GT(found.direction_in_world.x(), 0.999);
}

TEST(Penetration, OfAnOpenSheet) {
  // A square in the plane x = 30: its surface alone counts.
  TriangleMesh sheet{{{30, -20, -20}, {30, 20, -20}, {30, 20, 20}, {30, -20, 20}}, {{0, 1, 2}, {0, 2, 3}}};
  ExpectBounds(PenetrationOf(BoxHull(), TreeOf(std::move(sheet))), 20.0, kBoxHullMm);
}

TEST(Penetration, SaysWhenTheWorkspaceEndsTheWay) {
  const Penetration found = PenetrationOf(FullHull(), TreeOf(CubeAround({80, 0, 0}, 20.0)));
  EXPECT_TRUE(found.leaves_workspace);
  EXPECT_NEAR(found.upper_mm, 25.0, kToleranceMm);
}

// Points of the part: its bounds' lattice where that is inside, and its corners.
std::vector<Vector3d> SamplesOf(const core::TriangleTree& part, const core::RigidTransform& world_from_part) {
  std::vector<Vector3d> samples;
  const Eigen::AlignedBox3d& box = part.bounds();
  const Eigen::Vector3i steps = (box.sizes() / kSampleMm).array().ceil().cast<int>();
  for (int i = 0; i <= steps.x(); ++i)
    for (int j = 0; j <= steps.y(); ++j)
      for (int k = 0; k <= steps.z(); ++k) {
        const Vector3d share = Vector3d(i, j, k).cwiseQuotient(steps.cast<double>());
        const Vector3d x = box.min() + share.cwiseProduct(box.sizes());
        if (IsInsideClosedMesh(part, x)) samples.push_back(world_from_part * x);
      }
  for (const Vector3d& vertex : part.mesh().vertices_mm) samples.push_back(world_from_part * vertex);
  return samples;
}

bool AnyInHull(const VisualHull& hull, const std::vector<Vector3d>& samples, const Vector3d& moved_by_mm) {
  return std::ranges::any_of(samples, [&](const Vector3d& x) { return hull.Contains(x + moved_by_mm); });
}

struct Trial {
  VisualHull hull;
  core::TriangleTree part;
  core::RigidTransform world_from_part;
  std::vector<Vector3d> samples;
};

Trial RandomTrial(Random* random, int number) {
  const auto unseen = number % 3 == 0 ? core::UnseenPolicy::kAbstain : core::UnseenPolicy::kOutside;
  const recon::RandomScene scene = MakeRingScene(random, random->Whole(2, 4), unseen);
  const Vector3d sides(random->Uniform(8, 60), random->Uniform(8, 60), random->Uniform(8, 60));
  TriangleMesh mesh = number % 2 == 0 ? BoxAround(Vector3d::Zero(), sides)
                                      : SphereAround(Vector3d::Zero(), 0.5 * sides.x(), 2);
  Trial trial{recon::MakeVisualHull(scene.rig, scene.masks),
              TreeOf(std::move(mesh)),
              {random->Rotation(), 40.0 * random->Direction()},
              {}};
  trial.samples = SamplesOf(trial.part, trial.world_from_part);
  return trial;
}

bool IsOfPart(const Trial& trial, const Vector3d& x_in_world) {
  constexpr double kRoundingMm = 1e-6;
  const Vector3d x_in_part = trial.world_from_part.Inverse() * x_in_world;
  return IsInsideClosedMesh(trial.part, x_in_part) ||
         FindNearest(trial.part, {.center = x_in_part}).distance_mm <= kRoundingMm;
}

TEST(EscapeDistance, IsNeverContradictedBySamples) {
  constexpr double kWayStepMm = 0.25;
  Random random(7501);
  int ways = 0, tight = 0;
  for (int number = 0; ways < 40 * test_support::SoakScale(); ++number) {
    const Trial trial = RandomTrial(&random, number);
    if (!AnyInHull(trial.hull, trial.samples, Vector3d::Zero())) continue;
    ++ways;
    const Vector3d direction = random.Direction();
    std::vector<Vector3d> witnesses;
    const EscapeDistance found = FindEscapeDistance(trial.hull, trial.part, trial.world_from_part, direction,
                                                    &witnesses, {.tolerance_mm = kToleranceMm});
    ASSERT_LE(found.lower_mm, found.upper_mm);
    ASSERT_TRUE(std::isfinite(found.upper_mm));
    EXPECT_FALSE(AnyInHull(trial.hull, trial.samples, found.upper_mm * direction)) << number;
    // Before lower some witness is in the hull, and each is of the part.
    for (double at_mm = 0.0; at_mm < found.lower_mm; at_mm += kWayStepMm)
      EXPECT_TRUE(std::ranges::any_of(
          witnesses, [&](const Vector3d& x) { return trial.hull.Contains(x + at_mm * direction); }))
          << number << " at " << at_mm;
    for (const Vector3d& x : witnesses) EXPECT_TRUE(IsOfPart(trial, x)) << number;
    tight += found.upper_mm - found.lower_mm <= kToleranceMm ? 1 : 0;
  }
  EXPECT_GT(tight, ways * 9 / 10);
}

TEST(Penetration, IsNeverContradictedBySamples) {
  Random random(7502);
  int trials = 0;
  double lower_mm = 0.0, upper_mm = 0.0;
  for (int number = 0; trials < 25 * test_support::SoakScale(); ++number) {
    const Trial trial = RandomTrial(&random, number);
    const core::PartContact contact = FindContacts(trial.hull, trial.part, trial.world_from_part, 0);
    if (contact.verdict != core::Verdict::kContact) continue;
    ++trials;
    const Penetration found =
        FindPenetration(trial.hull, trial.part, trial.world_from_part, contact, kToleranceMm);
    lower_mm += found.lower_mm;
    upper_mm += found.upper_mm;
    ASSERT_LE(found.lower_mm, found.upper_mm);
    EXPECT_FALSE(AnyInHull(trial.hull, trial.samples, found.upper_mm * found.direction_in_world)) << number;
    // Shorter than lower nothing is free; samples see that where the parts still share enough.
    for (int i = 0; i < 20; ++i) {
      const double length_mm = found.lower_mm - 2.0 * kMissedMm;
      if (length_mm <= 0.0) break;
      EXPECT_TRUE(AnyInHull(trial.hull, trial.samples, length_mm * random.Direction())) << number;
    }
  }
  constexpr double kApart = 1.5;  // shapes of many kinds: bounds that say next to nothing would be farther
  EXPECT_LT(upper_mm, kApart * lower_mm);
}

TEST(HullPartIntersection, AgreesWithSamples) {
  Random random(7503);
  int apart = 0, meets = 0, open = 0;
  for (int number = 0; number < 250; ++number) {
    const Trial trial = RandomTrial(&random, number);
    std::int64_t queries = 0;
    const HullPartIntersection meeting =
        FindHullPartIntersection(trial.hull, trial.part, trial.world_from_part, 0.25, &queries);
    EXPECT_GT(queries, 0);
    if (meeting.answer == HullPartIntersection::Answer::kApart) {
      ++apart;
      EXPECT_FALSE(AnyInHull(trial.hull, trial.samples, Vector3d::Zero()));
    } else if (meeting.answer == HullPartIntersection::Answer::kIntersects) {
      ++meets;
      EXPECT_TRUE(trial.hull.Contains(meeting.common_in_world));
    } else {
      ++open;
    }
  }
  EXPECT_GT(apart, 20);
  EXPECT_GT(meets, 20);
  EXPECT_LT(open, 10);
}

TEST(EscapeDistance, GivesUpWhereTheWayIsSureToBeLonger) {
  const core::TriangleTree part = TreeOf(CubeAround({0, 0, 0}, 20.0));
  std::vector<Vector3d> witnesses = {{0, 0, 10}};
  const EscapeDistance found =
      FindEscapeDistance(BoxHull(), part, {}, Vector3d::UnitX(), &witnesses, {kToleranceMm, 30.0});
  EXPECT_GE(found.lower_mm, 30.0);
  EXPECT_TRUE(std::isinf(found.upper_mm));
  EXPECT_EQ(found.queries, 0) << "one ray says so";
}

TEST(EscapeDistance, OfAPartThatIsFreeIsNothing) {
  std::vector<Vector3d> witnesses;
  const EscapeDistance found =
      FindEscapeDistance(BoxHull(), TreeOf(CubeAround({80, 0, 0}, 20.0)), {}, Vector3d::UnitX(), &witnesses);
  EXPECT_EQ(found.lower_mm, 0.0);
  EXPECT_EQ(found.upper_mm, 0.0);
}

TEST(EscapeDistance, RefusesOptionsOutOfRange) {
  const core::TriangleTree part = TreeOf(CubeAround({0, 0, 0}, 20.0));
  std::vector<Vector3d> none;
  for (const EscapeOptions& options : {EscapeOptions{0.0}, {std::nan("")}, {0.5, -1.0}})
    EXPECT_THROW((void)FindEscapeDistance(BoxHull(), part, {}, Vector3d::UnitX(), &none, options),
                 core::Error);
  EXPECT_THROW((void)FindEscapeDistance(BoxHull(), part, {}, Vector3d(1, 1, 0), &none),
               core::PreconditionError);
}

}  // namespace
}  // namespace elbowroom::review
