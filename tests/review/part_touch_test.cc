// FindTouch and FindDeeper answer what FindContacts answers, with less work.
#include <gtest/gtest.h>

#include <memory>
#include <random>

#include "recon/hull/visual_hull.h"
#include "review/contacts.h"
#include "tests/core/solids.h"
#include "tests/recon/scenes/random_scene.h"
#include "tests/review/box_hull.h"
#include "tests/review/random_parts.h"
#include "tests/support/soak.h"

namespace elbowroom::review {
namespace {

using core::TriangleMesh;
using Eigen::Vector3d;

struct Census {
  int touches = 0;
  int clear = 0;
  int deeper = 0;
  std::int64_t queries_of_all = 0;
  std::int64_t queries_of_touch = 0;
  std::int64_t queries_of_depth = 0;
};

void CheckDepths(const recon::VisualHull& hull, const core::TriangleTree& part,
                 const core::RigidTransform& pose, const ContactOptions& options, double deepest_mm,
                 Census* census) {
  for (const double share : {0.0, 0.5, 0.9, 0.999}) {
    if (!(deepest_mm > 0.0)) break;
    std::int64_t queries = 0;
    const auto deeper = FindDeeper(hull, part, pose, options, share * deepest_mm, &queries);
    ASSERT_TRUE(deeper.has_value()) << share;
    EXPECT_EQ(*deeper, deepest_mm) << share;
    ++census->deeper;
  }
  EXPECT_FALSE(FindDeeper(hull, part, pose, options, deepest_mm, &census->queries_of_depth).has_value());
}

void Check(const recon::VisualHull& hull, const core::TriangleTree& part, const core::RigidTransform& pose,
           const ContactOptions& options, Census* census) {
  const core::PartContact contact = FindContacts(hull, part, pose, 0, options);
  const PartTouch touch = FindTouch(hull, part, pose, options);
  EXPECT_EQ(touch.touches, contact.verdict == core::Verdict::kContact);
  EXPECT_EQ(touch.surface_in_world_mm.has_value(), contact.contact_point_count > 0);
  if (touch.surface_in_world_mm) {
    EXPECT_TRUE(hull.Contains(*touch.surface_in_world_mm));
    EXPECT_LE(touch.queries, contact.count.queries);
    census->queries_of_touch += touch.queries;
    census->queries_of_all += contact.count.queries;
  }
  ++(touch.touches ? census->touches : census->clear);
  CheckDepths(hull, part, pose, options, contact.deepest ? contact.deepest->depth_mm : 0.0, census);
}

// Contact points far apart and close together, against the hull's own thickness.
ContactOptions OptionsOf(int trial) {
  ContactOptions options;
  options.point_spacing_mm = trial % 3 == 0 ? 10.0 : trial % 3 == 1 ? 3.0 : 0.8;
  options.resolution_mm = trial % 2 == 0 ? 0.5 : 0.0;
  return options;
}

TEST(PartTouch, AgreesWithAllContactsOfRandomParts) {
  recon::Random random(7717);
  std::mt19937_64 of_parts(7718);
  Census census;
  for (int trial = 0; trial < 60 * test_support::SoakScale(); ++trial) {
    SCOPED_TRACE(trial);
    const auto unseen = trial % 2 == 0 ? core::UnseenPolicy::kOutside : core::UnseenPolicy::kAbstain;
    const recon::RandomScene scene = MakeRingScene(&random, random.Whole(2, 5), unseen);
    const recon::VisualHull hull = recon::MakeVisualHull(scene.rig, scene.masks);
    const core::TriangleTree part(std::make_shared<const TriangleMesh>(
        testing::MakePart(static_cast<testing::PartKind>(trial % testing::kPartKinds), of_parts)));
    for (int i = 0; i < 4; ++i)
      Check(hull, part, {random.Rotation(), random.PointIn(scene.rig->workspace_mm)}, OptionsOf(trial),
            &census);
  }
  EXPECT_GT(census.touches, 40);
  EXPECT_GT(census.clear, 40);
  EXPECT_GT(census.deeper, 100);
}

// A panel through a hull that is thick beside its contact points' distances: most of it is deep.
TEST(PartTouch, AgreesWithAllContactsDeepInAHullAndCostsLess) {
  recon::Random random(7719);
  const core::TriangleTree panel(std::make_shared<const TriangleMesh>(
      core::Transformed(core::testing::Box({400.0, 400.0, 2.0}),
                        {Eigen::Matrix3d::Identity(), Vector3d(-200.0, -200.0, -1.0)})));
  Census census;
  for (int trial = 0; trial < 30; ++trial) {
    SCOPED_TRACE(trial);
    Check(BoxHull(), panel, {random.Rotation(), random.Uniform(0.0, 45.0) * random.Direction()},
          OptionsOf(trial), &census);
  }
  EXPECT_GT(census.touches, 25);
  EXPECT_LT(census.queries_of_touch, census.queries_of_all / 20);
  EXPECT_LT(census.queries_of_depth, census.queries_of_all / 4);
}

TEST(PartTouch, HullInsideAPartIsATouchWithoutAPointOfTheSurface) {
  const core::TriangleTree box(std::make_shared<const TriangleMesh>(core::Transformed(
      core::testing::Box({260.0, 260.0, 260.0}), {Eigen::Matrix3d::Identity(), Vector3d::Constant(-130.0)})));
  const PartTouch touch = FindTouch(BoxHull(), box, {}, {});
  EXPECT_TRUE(touch.touches);
  EXPECT_FALSE(touch.surface_in_world_mm.has_value());
}

}  // namespace
}  // namespace elbowroom::review
