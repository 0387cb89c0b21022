// Contacts against dense sampling of the part's surface with Contains() alone.
#include "review/contacts.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/error.h"
#include "recon/hull/visual_hull.h"
#include "tests/core/solids.h"
#include "tests/recon/scenes/random_scene.h"
#include "tests/review/box_hull.h"

namespace elbowroom::review {
namespace {

using core::TriangleMesh;
using Eigen::Vector3d;
using recon::Random;
using recon::VisualHull;

constexpr double kResolutionMm = 1.0;
constexpr int kAllPoints = 10'000'000;

struct Sample {
  Vector3d position;  // in world
  double area_mm2;
};

// Centres of small equal pieces of every triangle, at most `size_mm` long.
std::vector<Sample> SampleSurface(const TriangleMesh& mesh, const core::RigidTransform& world_from_part,
                                  double size_mm) {
  std::vector<Sample> samples;
  for (const auto& triangle : mesh.triangles) {
    std::array<Vector3d, 3> v;
    for (std::size_t k = 0; k < 3; ++k)
      v[k] = world_from_part * mesh.vertices_mm[static_cast<std::size_t>(triangle[k])];
    const Vector3d u = v[1] - v[0], w = v[2] - v[0];
    const double longest = std::max({u.norm(), w.norm(), (u - w).norm()});
    const int n = std::max(1, static_cast<int>(std::ceil(longest / size_mm)));
    const double area = 0.5 * u.cross(w).norm() / (static_cast<double>(n) * n);
    for (int i = 0; i < n; ++i) {
      for (int j = 0; i + j < n; ++j) {
        samples.push_back({v[0] + (i + 1.0 / 3) / n * u + (j + 1.0 / 3) / n * w, area});
        if (i + j + 1 < n) samples.push_back({v[0] + (i + 2.0 / 3) / n * u + (j + 2.0 / 3) / n * w, area});
      }
    }
  }
  return samples;
}

TriangleMesh CubeAround(const Vector3d& center, double side_mm) {
  return core::Transformed(core::testing::Box(Vector3d::Constant(side_mm)),
                           {Eigen::Matrix3d::Identity(), center - Vector3d::Constant(0.5 * side_mm)});
}

core::PartContact Find(const VisualHull& hull, const TriangleMesh& mesh, const ContactOptions& options = {},
                       const core::RigidTransform& world_from_part = {}) {
  return FindContacts(hull, core::TriangleTree(std::make_shared<const TriangleMesh>(mesh)), world_from_part,
                      7, options);
}

ContactOptions FineContacts() {
  ContactOptions options;
  options.resolution_mm = kResolutionMm;
  options.max_points = kAllPoints;
  return options;
}

// Boxes and a soup of plain triangles, needles, slivers, points, all about the hull.
TriangleMesh RandomPart(Random* random) {
  TriangleMesh mesh = CubeAround(40.0 * random->Direction(), random->Uniform(5.0, 60.0));
  for (int i = 0; i < 25; ++i) {
    const Vector3d a = random->Uniform(0.0, 80.0) * random->Direction();
    const double size = random->LogUniform(0.1, 60.0), thin = i % 3 == 0 ? 1e-3 : 1.0;
    const Vector3d b = a + size * random->Direction();
    const Vector3d c = a + random->Uniform(0.0, 1.0) * (b - a) + size * thin * random->Direction();
    core::Append(mesh, {{a, b, c}, {{0, 1, 2}}});
    if (i % 5 == 0) core::Append(mesh, {{a, b, c}, {{0, 1, 2}}});              // a duplicate
    if (i % 7 == 0) core::Append(mesh, {{a, b, 0.5 * (a + b)}, {{0, 1, 2}}});  // no area
    if (i % 11 == 0) core::Append(mesh, {{a, a, a}, {{0, 1, 2}}});             // a point
  }
  return mesh;
}

double NearestPointMm(const core::PartContact& contact, const Vector3d& x) {
  double nearest = HUGE_VAL;
  for (const core::ContactPoint& point : contact.points)
    nearest = std::min(nearest, (point.position_in_world_mm - x).norm());
  return nearest;
}

TEST(FindContacts, AgreesWithDenseSampling) {
  Random random(6001);
  double found_mm2 = 0.0, truth_mm2 = 0.0;
  int touching = 0, clear = 0;
  for (int trial = 0; trial < 40; ++trial) {
    const auto unseen = trial % 2 == 0 ? core::UnseenPolicy::kOutside : core::UnseenPolicy::kAbstain;
    const recon::RandomScene scene = MakeRingScene(&random, random.Whole(2, 5), unseen);
    const VisualHull hull = recon::MakeVisualHull(scene.rig, scene.masks);
    const TriangleMesh part = RandomPart(&random);
    const core::RigidTransform world_from_part{random.Rotation(), 60.0 * random.Direction()};
    const core::PartContact contact = Find(hull, part, FineContacts(), world_from_part);
    (contact.verdict == core::Verdict::kContact ? touching : clear) += 1;

    double inside_mm2 = 0.0, band_mm2 = 0.0;
    int sampled = 0;
    for (const Sample& sample : SampleSurface(part, world_from_part, 0.7 * kResolutionMm)) {
      const recon::PointAnswer answer = hull.Probe(sample.position);
      if (answer.is_inside) inside_mm2 += sample.area_mm2;
      if (answer.radius_mm < 2.0 * kResolutionMm) band_mm2 += sample.area_mm2;
      // What is this deep can't be missed: every piece around it is inside.
      if (!answer.is_inside || answer.radius_mm < kResolutionMm || ++sampled % 50 != 0) continue;
      ASSERT_EQ(contact.verdict, core::Verdict::kContact);
      ASSERT_LE(NearestPointMm(contact, sample.position), ContactOptions().point_spacing_mm);
    }
    ASSERT_LE(std::abs(contact.contact_area_mm2 - inside_mm2), band_mm2 + 1e-6) << trial;
    found_mm2 += contact.contact_area_mm2;
    truth_mm2 += inside_mm2;
    for (const core::ContactPoint& point : contact.points) {
      ASSERT_TRUE(hull.Contains(point.position_in_world_mm)) << "no false contact";
      ASSERT_EQ(hull.Classify(point.position_in_world_mm, point.depth_mm), recon::BallAnswer::kInside);
    }
  }
  EXPECT_GT(touching, 20);
  constexpr double kMeanError = 0.005;  // pieces err to both sides alike
  EXPECT_NEAR(found_mm2, truth_mm2, kMeanError * truth_mm2);
}

TEST(FindContacts, PartWhollyInside) {
  // Its ball's radius is 26 mm: labels are certain for at least 29 px, 45 px from the contour.
  const TriangleMesh part = CubeAround(Vector3d(5, -3, 2), 30.0);
  ContactOptions options;
  options.max_points = kAllPoints;
  const core::PartContact contact = Find(BoxHull(), part, options);
  EXPECT_EQ(contact.verdict, core::Verdict::kContact);
  EXPECT_EQ(contact.part, 7U);
  EXPECT_NEAR(contact.contact_area_mm2, core::AreaMm2(part), 1e-6);
  EXPECT_EQ(contact.count.triangles, 12);
  EXPECT_EQ(contact.count.skipped, 12) << "all settled by the tree's ball";
  EXPECT_EQ(contact.count.queries, 1 + contact.contact_point_count) << "and one for each point's depth";
  EXPECT_EQ(static_cast<std::int64_t>(contact.points.size()), contact.contact_point_count);
  // Its deepest face is 50 - 10 mm inside; labels are asked no farther than they are sure for.
  ASSERT_TRUE(contact.deepest.has_value());
  EXPECT_GT(contact.deepest->depth_mm, 29.0);
  EXPECT_LT(contact.deepest->depth_mm, 40.0);
  EXPECT_EQ(contact.recovery_status, core::RecoveryStatus::kReferenceInsideHull);
}

TEST(FindContacts, FarPartCostsOneQuery) {
  for (const Vector3d& at : {Vector3d(80, 80, 80), Vector3d(5000, 0, 0)}) {
    const core::PartContact contact = Find(BoxHull(), CubeAround(at, 20.0));
    EXPECT_EQ(contact.verdict, core::Verdict::kClear);
    EXPECT_EQ(contact.count.queries, 1);
    EXPECT_EQ(contact.count.skipped, 12);
    EXPECT_TRUE(contact.points.empty());
    EXPECT_EQ(contact.contact_area_mm2, 0.0);
    EXPECT_FALSE(contact.deepest.has_value());
    EXPECT_EQ(contact.recovery_status, core::RecoveryStatus::kNoContact);
  }
}

TEST(FindContacts, GapAndTouchOfATenthOfAMillimetre) {
  // A face 0.1 mm outside the hull's: clear. 0.1 mm inside: all of the face that faces it.
  const core::PartContact clear = Find(BoxHull(), CubeAround(Vector3d(60.1, 0, 0), 20.0), FineContacts());
  EXPECT_EQ(clear.verdict, core::Verdict::kClear);
  const core::PartContact touch = Find(BoxHull(), CubeAround(Vector3d(59.9, 0, 0), 20.0), FineContacts());
  EXPECT_EQ(touch.verdict, core::Verdict::kContact);
  // The face, and 0.1 mm of four sides that pieces of the resolution may or may not count.
  EXPECT_NEAR(touch.contact_area_mm2, 400.0, 4 * 20.0 * kResolutionMm);
  EXPECT_LE(touch.deepest->depth_mm, 0.1 + kBoxHullMm);
}

TEST(FindContacts, HullWhollyInsideAClosedPartIsAContactWithoutPoints) {
  const core::PartContact contact = Find(BoxHull(), CubeAround(Vector3d::Zero(), 120.0));
  EXPECT_EQ(contact.verdict, core::Verdict::kContact);
  EXPECT_EQ(contact.contact_point_count, 0);
  EXPECT_EQ(contact.recovery_status, core::RecoveryStatus::kHullInsidePart);
  EXPECT_FALSE(contact.recovery.has_value());
  ASSERT_TRUE(contact.contained_in_world_mm);
  EXPECT_TRUE(BoxHull().Contains(*contact.contained_in_world_mm));
}

TEST(FindContacts, HullWhollyInsideAnOpenPartIsNotLookedFor) {
  core::TriangleMesh open = CubeAround(Vector3d::Zero(), 120.0);
  open.triangles.pop_back();
  EXPECT_EQ(Find(BoxHull(), open).verdict, core::Verdict::kClear);
}

TEST(FindContacts, HullInTheCavityOfAClosedPartIsClear) {
  core::TriangleMesh shell = CubeAround(Vector3d::Zero(), 200.0),
                     cavity = CubeAround(Vector3d::Zero(), 120.0);
  for (auto& triangle : cavity.triangles) std::swap(triangle[1], triangle[2]);
  core::Append(shell, cavity);
  EXPECT_EQ(Find(BoxHull(), shell).verdict, core::Verdict::kClear);
}

TEST(FindContacts, KeptCellsOfThePartsInsideChangeNothing) {
  Random random(6009);
  TriangleMesh shell = CubeAround(Vector3d::Zero(), 260.0), cavity = CubeAround(Vector3d(12, 0, 0), 220.0);
  for (auto& triangle : cavity.triangles) std::swap(triangle[1], triangle[2]);
  core::Append(shell, cavity);
  const core::TriangleTree part(std::make_shared<const TriangleMesh>(shell));
  InsideCells inside(part);
  int contained = 0, clear = 0;
  const VisualHull hull = BoxHull();
  for (int trial = 0; trial < 40; ++trial) {
    const core::RigidTransform world_from_part{random.Rotation(),
                                               random.Uniform(0.0, 60.0) * random.Direction()};
    const core::PartContact kept = FindContacts(hull, part, world_from_part, 0, FineContacts(), &inside);
    const core::PartContact fresh = FindContacts(hull, part, world_from_part, 0, FineContacts());
    EXPECT_EQ(kept.verdict, fresh.verdict);
    EXPECT_EQ(kept.contained_in_world_mm, fresh.contained_in_world_mm);
    EXPECT_EQ(kept.count.queries, fresh.count.queries);
    clear += kept.verdict == core::Verdict::kClear ? 1 : 0;
  }
  EXPECT_GT(clear, 3);
  const core::TriangleTree box(std::make_shared<const TriangleMesh>(CubeAround(Vector3d::Zero(), 200.0)));
  InsideCells inside_box(box);
  for (int trial = 0; trial < 20; ++trial) {
    const core::RigidTransform world_from_part{random.Rotation(),
                                               random.Uniform(0.0, 20.0) * random.Direction()};
    const core::PartContact kept = FindContacts(hull, box, world_from_part, 0, FineContacts(), &inside_box);
    EXPECT_EQ(kept.contained_in_world_mm,
              FindContacts(hull, box, world_from_part, 0, FineContacts()).contained_in_world_mm);
    contained += kept.contained_in_world_mm ? 1 : 0;
  }
  EXPECT_GT(contained, 10);
}

// Faces far larger than what is searched alone.
TEST(FindContacts, OneThreadFindsWhatManyFind) {
  Random random(6010);
  for (int trial = 0; trial < 10; ++trial) {
    const core::RigidTransform world_from_part{random.Rotation(), 60.0 * random.Direction()};
    const TriangleMesh part = CubeAround(Vector3d(200.0, 0.0, 0.0), 400.0);
    ContactOptions options;
    options.point_spacing_mm = 4.0;
    const core::PartContact many = Find(BoxHull(), part, options, world_from_part);
    const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
    const core::PartContact one = Find(BoxHull(), part, options, world_from_part);
    ASSERT_GT(one.contact_point_count, 10);
    EXPECT_EQ(one.contact_area_mm2, many.contact_area_mm2);
    EXPECT_EQ(one.count.queries, many.count.queries);
    EXPECT_EQ(one.count.skipped, many.count.skipped);
    EXPECT_EQ(one.deepest->position_in_world_mm, many.deepest->position_in_world_mm);
    ASSERT_EQ(one.points.size(), many.points.size());
    for (std::size_t i = 0; i < one.points.size(); ++i) {
      EXPECT_EQ(one.points[i].position_in_world_mm, many.points[i].position_in_world_mm);
      EXPECT_EQ(one.points[i].depth_mm, many.points[i].depth_mm);
    }
    ASSERT_EQ(one.recovery.has_value(), many.recovery.has_value());
    if (one.recovery) {
      EXPECT_EQ(one.recovery->cp_obj_in_world_mm, many.recovery->cp_obj_in_world_mm);
    }
  }
}

TEST(FindContacts, RecoveryBacksOutOfTheNearFace) {
  const VisualHull hull = BoxHull();
  // Reaches 10 mm into the face x = 50; its reference, the centre, is outside.
  const core::PartContact contact = Find(hull, CubeAround(Vector3d(60, 0, 0), 40.0), FineContacts());
  ASSERT_EQ(contact.recovery_status, core::RecoveryStatus::kFound);
  const core::Recovery& recovery = *contact.recovery;
  const Vector3d rp_obj(60, 0, 0);
  EXPECT_NEAR((recovery.cp_obj_in_world_mm - rp_obj).norm(), std::sqrt(3.0) * 20.0, 2.0 * kResolutionMm);
  EXPECT_NEAR(recovery.cp_obj_in_world_mm.x(), 40.0, kResolutionMm);
  EXPECT_NEAR(recovery.cp_hull_in_world_mm.x(), 50.0, kBoxHullMm);
  EXPECT_NEAR(recovery.v_rec_in_world.norm(), 1.0, 1e-12);
  EXPECT_LT((recovery.cp_obj_in_world_mm + recovery.d_rec_mm * recovery.v_rec_in_world -
             recovery.cp_hull_in_world_mm)
                .norm(),
            1e-9);
  EXPECT_LT((rp_obj - recovery.cp_obj_in_world_mm).normalized().cross(recovery.v_rec_in_world).norm(), 1e-9);
  constexpr double kOutMm = 1e-4;
  EXPECT_TRUE(hull.Contains(recovery.cp_hull_in_world_mm - kOutMm * recovery.v_rec_in_world));
  EXPECT_FALSE(hull.Contains(recovery.cp_hull_in_world_mm + kOutMm * recovery.v_rec_in_world));
  ASSERT_TRUE(recovery.n_hull_in_world.has_value());
  EXPECT_GT(recovery.n_hull_in_world->x(), 0.999);
}

TEST(FindContacts, ReferenceOfTheCallersChoice) {
  ContactOptions options = FineContacts();
  options.recovery.reference_in_part_mm =
      Vector3d(20, 0, 0);  // world (80, 0, 0): outside, though the centre is inside
  const core::RigidTransform world_from_part{Eigen::Matrix3d::Identity(), Vector3d(60, 0, 0)};
  const TriangleMesh part = CubeAround(Vector3d(-20, 0, 0), 60.0);
  EXPECT_EQ(Find(BoxHull(), part, FineContacts(), world_from_part).recovery_status,
            core::RecoveryStatus::kReferenceInsideHull);
  const core::PartContact contact = Find(BoxHull(), part, options, world_from_part);
  ASSERT_EQ(contact.recovery_status, core::RecoveryStatus::kFound);
  // 60 mm deep: deeper than the triangles' own 5 cm search would have reached.
  EXPECT_GT(contact.recovery->d_rec_mm, 30.0);
  EXPECT_NEAR(contact.recovery->cp_hull_in_world_mm.x(), 50.0, kBoxHullMm);
}

TEST(FindContacts, NoDirectionWhenReferenceIsTheContact) {
  const TriangleMesh part{{Vector3d(1, 1, 0)}, {{0, 0, 0}}};  // a point
  ContactOptions options;
  options.recovery.reference_in_part_mm = Vector3d(1, 1, 0);
  const core::PartContact contact = Find(BoxHull(), part, options);
  EXPECT_EQ(contact.verdict, core::Verdict::kContact);
  EXPECT_EQ(contact.recovery_status, core::RecoveryStatus::kNoDirection);
  EXPECT_FALSE(contact.recovery.has_value());
}

TEST(FindContacts, MovingThePartsFrameChangesNothing) {
  Random random(6002);
  const VisualHull hull = BoxHull();
  for (int trial = 0; trial < 10; ++trial) {
    const TriangleMesh part = RandomPart(&random);
    const core::RigidTransform other_from_part{random.Rotation(), 500.0 * random.Direction()};
    const core::PartContact here = Find(hull, part, FineContacts());
    const core::PartContact there =
        Find(hull, core::Transformed(part, other_from_part), FineContacts(), other_from_part.Inverse());
    EXPECT_EQ(here.verdict, there.verdict);
    // A tie between two sides may be cut the other way: pieces at the boundary change, their sum hardly.
    constexpr double kShare = 0.01;
    EXPECT_NEAR(here.contact_area_mm2, there.contact_area_mm2, kShare * here.contact_area_mm2 + 1e-6);
  }
}

TEST(FindContacts, BoundedPointsKeepAreaAndTheDeepest) {
  const TriangleMesh part = CubeAround(Vector3d(35, 0, 0), 60.0);
  const core::PartContact all = Find(BoxHull(), part, FineContacts());
  ContactOptions options = FineContacts();
  options.max_points = 16;
  const core::PartContact few = Find(BoxHull(), part, options);
  EXPECT_EQ(few.points.size(), 16U);
  EXPECT_EQ(few.contact_point_count, all.contact_point_count);
  EXPECT_EQ(few.contact_area_mm2, all.contact_area_mm2);
  double sum_mm2 = 0.0;
  for (const core::ContactPoint& point : few.points) sum_mm2 += point.area_mm2;
  EXPECT_NEAR(sum_mm2, few.contact_area_mm2, 1e-6);
  EXPECT_EQ(few.deepest->depth_mm, all.deepest->depth_mm) << "however many are kept";
}

TEST(FindContacts, DefaultResolutionIsHalfAPixelAtThePart) {
  const core::PartContact contact = Find(BoxHull(), CubeAround(Vector3d(60, 0, 0), 40.0));
  // 1 px a millimetre, to the certified stretch's own bound.
  EXPECT_NEAR(contact.resolution_mm, 0.5, 1e-3);
}

TEST(FindContacts, EmptyHullAndEmptyMesh) {
  Random random(6003);
  recon::RandomScene scene = MakeRingScene(&random, 2, core::UnseenPolicy::kOutside);
  scene.masks[0] = core::BitMask(160, 120);
  const VisualHull empty = recon::MakeVisualHull(scene.rig, scene.masks);
  EXPECT_EQ(Find(empty, CubeAround(Vector3d::Zero(), 10.0)).count.queries, 0);
  EXPECT_EQ(Find(BoxHull(), {}).verdict, core::Verdict::kClear);
}

TEST(FindContacts, RefusesOptionsOutOfRange) {
  const auto refused = [](auto change) {
    ContactOptions options;
    change(&options);
    EXPECT_THROW((void)Find(BoxHull(), CubeAround(Vector3d::Zero(), 10.0), options), core::Error);
  };
  refused([](ContactOptions* o) { o->resolution_mm = -1.0; });
  refused([](ContactOptions* o) { o->resolution_mm = std::nan(""); });
  refused([](ContactOptions* o) { o->point_spacing_mm = 0.0; });
  refused([](ContactOptions* o) { o->point_spacing_mm = std::nan(""); });
  refused([](ContactOptions* o) { o->max_points = 0; });
  refused([](ContactOptions* o) { o->recovery.kind = core::RecoveryKind::kSlider; });
}

TEST(PixelFootprint, IsThatOfTheNearestLookingCamera) {
  const VisualHull hull = BoxHull();
  EXPECT_NEAR(PixelFootprintMm(hull.rig(), Vector3d::Zero()).value(), 1.0, 1e-3);
  EXPECT_NEAR(PixelFootprintMm(hull.rig(), Vector3d(5e5, 0, 0)).value(), 0.5, 1e-3);
  EXPECT_FALSE(PixelFootprintMm(hull.rig(), Vector3d(2e6, 2e6, 2e6)).has_value());
}

}  // namespace
}  // namespace elbowroom::review
