#include "review/clash.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <memory>
#include <random>

#include "core/error.h"
#include "tests/core/solids.h"
#include "tests/oracles/mesh_gap.h"
#include "tests/review/fcl_answers.h"
#include "tests/review/random_parts.h"
#include "tests/support/soak.h"

namespace elbowroom::review {
namespace {

using core::RigidTransform;
using core::TriangleMesh;
using core::Verdict;
using Eigen::Vector3d;

// Parts of 10 to 100 mm near their frame's origin: rounding in double is some 1e-13 mm.
constexpr double kClashRoundingMm = 1e-9;

core::Layout LayoutOf(const std::vector<core::SharedMesh>& meshes) {
  core::Layout layout;
  for (const core::SharedMesh& mesh : meshes)
    layout.parts.push_back({std::string(1, static_cast<char>('a' + layout.parts.size())), "", {}, mesh, {}});
  return layout;
}

core::SharedMesh Shared(TriangleMesh mesh) { return std::make_shared<const TriangleMesh>(std::move(mesh)); }
core::SharedMesh SharedBox(double x, double y, double z) {
  return Shared(core::testing::Box(Vector3d(x, y, z)));
}

RigidTransform At(double x, double y, double z) { return {Eigen::Matrix3d::Identity(), {x, y, z}}; }

// One pair, all of it.
PairClash Judge(const core::SharedMesh& a, const RigidTransform& world_from_a, const core::SharedMesh& b,
                const RigidTransform& world_from_b, double required_mm = 0.0, double uncertainty_mm = 0.0) {
  ClashChecker checker(LayoutOf({a, b}), {{0, 1, required_mm, false}}, {uncertainty_mm, 0.0});
  return checker.Check(std::vector{world_from_a, world_from_b}).pairs.at(0);
}

double DistanceTo(const TriangleMesh& mesh, const RigidTransform& world_from_mesh, const Vector3d& x) {
  const TriangleMesh point{{x, x, x}, {{0, 1, 2}}};
  return static_cast<double>(oracles::GapOfMeshes(mesh, world_from_mesh, point, {}).distance_mm);
}

// The distance, on both surfaces, or a bound of it.
void ExpectGap(const PairClash& pair, double truth_mm, const TriangleMesh& a,
               const RigidTransform& world_from_a, const TriangleMesh& b, const RigidTransform& world_from_b,
               double rounding_mm) {
  EXPECT_LE(pair.at_least_mm, truth_mm + rounding_mm);
  if (!pair.gap) {
    EXPECT_EQ(pair.verdict, Verdict::kClear);
    return;
  }
  EXPECT_NEAR(pair.gap->distance_mm, truth_mm, rounding_mm);
  EXPECT_NEAR((pair.gap->on_a - pair.gap->on_b).norm(), truth_mm, rounding_mm);
  EXPECT_LE(DistanceTo(a, world_from_a, pair.gap->on_a), rounding_mm);
  EXPECT_LE(DistanceTo(b, world_from_b, pair.gap->on_b), rounding_mm);
}

// What the pair should have been judged by brute force; `rounding_mm` of the distance.
void ExpectAsByBruteForce(const PairClash& pair, const TriangleMesh& a, const RigidTransform& world_from_a,
                          const TriangleMesh& b, const RigidTransform& world_from_b, double rounding_mm) {
  const double truth_mm =
      static_cast<double>(oracles::GapOfMeshes(a, world_from_a, b, world_from_b).distance_mm);
  const double required_mm = pair.demand.required_mm;
  Verdict verdict = truth_mm < required_mm ? Verdict::kNear : Verdict::kClear;
  const bool meets = truth_mm <= kTouchMm;
  const bool contained = !meets && (oracles::HasVertexInside(a, world_from_a, b, world_from_b) ||
                                    oracles::HasVertexInside(b, world_from_b, a, world_from_a));
  if (meets || contained) verdict = Verdict::kContact;
  EXPECT_EQ(pair.verdict, verdict) << truth_mm << " mm apart";
  EXPECT_EQ(pair.contained, contained);
  ExpectGap(pair, truth_mm, a, world_from_a, b, world_from_b, rounding_mm);
}

// How FCL alone would have done.
struct FclTally {
  void Add(const testing::FclAnswers& fcl, const PairClash& pair, const TriangleMesh& a,
           const RigidTransform& world_from_a, const TriangleMesh& b, const RigidTransform& world_from_b) {
    const double truth_mm = pair.gap->distance_mm;
    const bool meets = truth_mm <= kTouchMm;
    missed += meets && !fcl.meets ? 1 : 0;
    made_up += !meets && fcl.meets ? 1 : 0;
    const double error_mm = std::abs(fcl.distance_mm - truth_mm);
    wrong += error_mm > kTouchMm ? 1 : 0;
    worst_mm = std::max(worst_mm, error_mm);
    if (DistanceTo(a, world_from_a, fcl.on_a) > kTouchMm ||
        DistanceTo(b, world_from_b, fcl.on_b) > kTouchMm ||
        std::abs((fcl.on_a - fcl.on_b).norm() - truth_mm) > kTouchMm)
      ++(meets ? wrong_points_of_touches : wrong_points);
  }

  void Print() const {
    std::printf(
        "FCL alone: %d touches missed, %d made up; %d distances wrong, by up to %.3g mm; nearest points "
        "wrong "
        "for %d pairs that are apart and %d that meet\n",
        missed, made_up, wrong, worst_mm, wrong_points, wrong_points_of_touches);
  }

  int missed = 0;                   // touches
  int made_up = 0;                  // touches
  int wrong = 0;                    // distances
  int wrong_points = 0;             // nearest points that don't show the distance, of parts that are apart
  int wrong_points_of_touches = 0;  // of parts that meet
  double worst_mm = 0.0;
};

TEST(Clash, RandomPairsAreAsByBruteForce) {
  const int count = 2500 * test_support::SoakScale();
  std::mt19937_64 random(20'261'121);
  std::uniform_int_distribution<int> kind(0, testing::kPartKinds - 1);
  int contacts = 0, contained = 0, near = 0, by_bounds = 0;
  FclTally fcl;
  for (int i = 0; i < count && !HasFailure(); ++i) {
    const auto a = Shared(MakePart(static_cast<testing::PartKind>(kind(random)), random));
    const auto b = Shared(MakePart(static_cast<testing::PartKind>(kind(random)), random));
    const testing::PairOfPoses poses = testing::MakePoses(random);
    const double required_mm = std::uniform_real_distribution<double>(0.0, 20.0)(random);
    SCOPED_TRACE(::testing::Message() << "pair " << i);
    const PairClash pair = Judge(a, poses.world_from_a, b, poses.world_from_b, required_mm);
    ExpectAsByBruteForce(pair, *a, poses.world_from_a, *b, poses.world_from_b, kClashRoundingMm);
    contacts += pair.verdict == Verdict::kContact ? 1 : 0;
    contained += pair.contained ? 1 : 0;
    near += pair.verdict == Verdict::kNear ? 1 : 0;
    by_bounds += pair.gap ? 0 : 1;
    if (pair.gap)
      fcl.Add(testing::AskFcl(*a, poses.world_from_a, *b, poses.world_from_b), pair, *a, poses.world_from_a,
              *b, poses.world_from_b);
  }
  std::printf("%d pairs: %d contacts (%d contained), %d near, %d clear by their bounds\n", count, contacts,
              contained, near, by_bounds);
  fcl.Print();
  EXPECT_GT(contained, count / 100);
  EXPECT_GT(near, count / 20);
}

// Parts of one triangle each, with one edge along one direction: where FCL's own distance fails most.
TEST(Clash, PartsWithParallelEdgesAreAsByBruteForce) {
  const int count = 2000 * test_support::SoakScale();
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const auto any = [&] { return Vector3d(10.0 * unit(random), 10.0 * unit(random), 10.0 * unit(random)); };
  FclTally fcl;
  for (int i = 0; i < count && !HasFailure(); ++i) {
    const Vector3d a = any(), along = any(), b = any() + any();
    const auto of_a = Shared({{a, a + along, any()}, {{0, 1, 2}}});
    const auto of_b = Shared({{b, b + 0.7 * along, any() + any()}, {{0, 1, 2}}});
    const RigidTransform turn = testing::AnyPose(random, 10.0);
    SCOPED_TRACE(::testing::Message() << "pair " << i);
    const PairClash pair = Judge(of_a, turn, of_b, turn, 100.0);
    ExpectAsByBruteForce(pair, *of_a, turn, *of_b, turn, kClashRoundingMm);
    // FCL joins equal poses to none, so it is given the turned triangles.
    const TriangleMesh turned_a = core::Transformed(*of_a, turn), turned_b = core::Transformed(*of_b, turn);
    fcl.Add(testing::AskFcl(turned_a, {}, turned_b, {}), pair, turned_a, {}, turned_b, {});
  }
  std::printf("%d pairs with parallel edges; ", count);
  fcl.Print();
}

TEST(Clash, FacesThatTouchExactlyAreInContact) {
  const auto box = SharedBox(10, 10, 10);
  for (const Vector3d& shift : {Vector3d(10, 0, 0), Vector3d(10, 3, 4), Vector3d(10, 10, 10)}) {
    const PairClash pair = Judge(box, {}, box, {Eigen::Matrix3d::Identity(), shift}, 5.0);
    EXPECT_EQ(pair.verdict, Verdict::kContact) << shift.transpose();
    EXPECT_FALSE(pair.contained);
  }
  EXPECT_EQ(Judge(box, {}, box, At(10.001, 0, 0), 5.0).verdict, Verdict::kNear);
  EXPECT_EQ(Judge(box, {}, box, At(10.001, 0, 0), 0.0).verdict, Verdict::kClear);
}

TEST(Clash, RequiredClearanceThatIsJustKeptIsKept) {
  const auto box = SharedBox(10, 10, 10);
  EXPECT_EQ(Judge(box, {}, box, At(15, 0, 0), 5.0).verdict, Verdict::kClear);
  EXPECT_EQ(Judge(box, {}, box, At(14.999, 0, 0), 5.0).verdict, Verdict::kNear);
}

TEST(Clash, APartInsideAClosedOneIsAContactOutsideItsSurfaceToo) {
  const auto crate = SharedBox(100, 100, 100), box = SharedBox(10, 10, 10);
  const PairClash inside = Judge(crate, {}, box, At(20, 30, 40));
  EXPECT_EQ(inside.verdict, Verdict::kContact);
  EXPECT_TRUE(inside.contained);
  ASSERT_TRUE(inside.gap);
  EXPECT_NEAR(inside.gap->distance_mm, 20.0, kClashRoundingMm);
  EXPECT_TRUE(Judge(box, At(20, 30, 40), crate, {}).contained);
  TriangleMesh open = *crate;
  open.triangles.pop_back();
  EXPECT_EQ(Judge(Shared(open), {}, box, At(20, 30, 40)).verdict, Verdict::kClear);
}

// As CAD systems export them: a body twice, an insert in its block, blocks that overlap.
TEST(Clash, BodiesOfAPartThatOverlapDontHollowIt) {
  const TriangleMesh crate = core::testing::Box({100, 100, 100});
  const auto box = SharedBox(2, 2, 2);
  const auto is_inside = [&](const RigidTransform& crate_from_second, const TriangleMesh& second,
                             const Eigen::Vector3d& place_mm) {
    TriangleMesh both = crate;
    core::Append(both, core::Transformed(second, crate_from_second));
    return Judge(Shared(both), {}, box, At(place_mm.x(), place_mm.y(), place_mm.z())).contained;
  };
  EXPECT_TRUE(is_inside({}, crate, {50, 50, 50})) << "there twice";
  EXPECT_TRUE(is_inside(At(50, 0, 0), crate, {75, 50, 50})) << "in both";
  EXPECT_TRUE(is_inside(At(50, 0, 0), crate, {125, 50, 50})) << "in the second alone";
  TriangleMesh insert = core::testing::Box({50, 50, 50});
  EXPECT_TRUE(is_inside(At(25, 25, 25), insert, {50, 50, 50})) << "in an insert";
  for (auto& [a, b, c] : insert.triangles) std::swap(b, c);
  EXPECT_FALSE(is_inside(At(25, 25, 25), insert, {50, 50, 50})) << "in a cavity";
  EXPECT_TRUE(is_inside(At(25, 25, 25), insert, {10, 50, 50})) << "beside the cavity";
}

TEST(Clash, OnePieceInsideIsEnough) {
  TriangleMesh two = core::testing::Box({10, 10, 10});
  core::Append(two, core::Transformed(two, At(500, 0, 0)));
  const auto crate = SharedBox(100, 100, 100), pieces = Shared(two);
  EXPECT_TRUE(Judge(crate, {}, pieces, At(20, 30, 40)).contained);
  EXPECT_TRUE(Judge(crate, {}, pieces, At(-480, 30, 40)).contained);
  EXPECT_FALSE(Judge(crate, {}, pieces, At(-200, 30, 40)).contained);
}

TEST(Clash, UncertaintyThatStraddlesAThresholdLeavesItUndecided) {
  const auto box = SharedBox(10, 10, 10);
  const auto verdict = [&](double gap_mm, double uncertainty_mm) {
    return Judge(box, {}, box, At(10 + gap_mm, 0, 0), 5.0, uncertainty_mm).verdict;
  };
  EXPECT_EQ(verdict(3.0, 0.5), Verdict::kNear);
  EXPECT_EQ(verdict(4.8, 0.5), Verdict::kUndecided);
  EXPECT_EQ(verdict(5.2, 0.5), Verdict::kUndecided);
  EXPECT_EQ(verdict(5.6, 0.5), Verdict::kClear);
  EXPECT_EQ(verdict(0.3, 0.5), Verdict::kUndecided);
  EXPECT_EQ(verdict(-1.0, 0.5), Verdict::kUndecided);  // how deep isn't known
  EXPECT_EQ(verdict(-1.0, 0.0), Verdict::kContact);
  const auto crate = SharedBox(100, 100, 100);
  EXPECT_EQ(Judge(crate, {}, box, At(20, 30, 40), 0.0, 19.0).verdict, Verdict::kContact);
  EXPECT_EQ(Judge(crate, {}, box, At(20, 30, 40), 0.0, 21.0).verdict, Verdict::kUndecided);
}

TEST(Clash, WhatTessellationCostLeavesAThresholdUndecidedButNotThatMeshesMeet) {
  TriangleMesh tessellated = core::testing::Box({10, 10, 10});
  tessellated.deviation_mm = 0.2;
  const auto box = SharedBox(10, 10, 10), off = Shared(tessellated);
  const auto pair = [&](double gap_mm, const core::SharedMesh& other) {
    return Judge(off, {}, other, At(10 + gap_mm, 0, 0), 5.0);
  };
  EXPECT_EQ(pair(4.7, box).verdict, Verdict::kNear);
  EXPECT_EQ(pair(4.9, box).verdict, Verdict::kUndecided);
  EXPECT_EQ(pair(5.1, box).verdict, Verdict::kUndecided);
  EXPECT_EQ(pair(5.3, box).verdict, Verdict::kClear);
  EXPECT_EQ(pair(5.3, off).verdict, Verdict::kUndecided) << "both are off";
  EXPECT_EQ(pair(5.3, off).deviation_mm, 0.4);
  EXPECT_EQ(pair(0.1, box).verdict, Verdict::kUndecided) << "touching, perhaps";
  EXPECT_EQ(pair(0.0, box).verdict, Verdict::kContact);
  EXPECT_EQ(pair(-1.0, off).verdict, Verdict::kContact);
}

// 10 km: what a vehicle's or a building's frame may put between the world's origin and the parts.
TEST(Clash, FarFromTheOriginNoDigitOfTheGapIsLost) {
  constexpr double kFarMm = 1e7, kRoundingFarMm = 2e-8;  // doubles there are 2e-9 apart, poses are such
  std::mt19937_64 random(7);
  for (int i = 0; i < 300 && !HasFailure(); ++i) {
    SCOPED_TRACE(i);
    const auto a = Shared(MakePart(static_cast<testing::PartKind>(i % 6), random));
    const auto b = Shared(MakePart(static_cast<testing::PartKind>(i / 6 % 6), random));
    testing::PairOfPoses poses = testing::MakePoses(random);
    const Vector3d offset(kFarMm, -kFarMm, 0.3 * kFarMm);
    poses.world_from_a.translation_mm += offset;
    poses.world_from_b.translation_mm += offset;
    ExpectAsByBruteForce(Judge(a, poses.world_from_a, b, poses.world_from_b, 20.0), *a, poses.world_from_a,
                         *b, poses.world_from_b, kRoundingFarMm);
  }
}

TEST(Clash, MeshesThatAreFarFromTheirOwnOriginLoseNoDigitEither) {
  constexpr double kFarMm = 1e7, kRoundingFarMm = 2e-8;  // doubles there are 2e-9 apart, vertices are such
  TriangleMesh a = core::testing::Box({10, 10, 10}), b = a;
  for (Vector3d& vertex : a.vertices_mm) vertex.array() += kFarMm;
  for (Vector3d& vertex : b.vertices_mm) vertex.array() -= kFarMm;
  const RigidTransform world_from_a = At(-kFarMm, -kFarMm, -kFarMm);
  RigidTransform world_from_b = At(kFarMm + 12.5, kFarMm, kFarMm);
  const PairClash pair = Judge(Shared(a), world_from_a, Shared(b), world_from_b, 5.0);
  ASSERT_TRUE(pair.gap);
  EXPECT_NEAR(pair.gap->distance_mm, 2.5, kRoundingFarMm);
  EXPECT_EQ(pair.verdict, Verdict::kNear);
}

// --- what is asked again -----------------------------------------------------------------------------------

// Nine boxes in a row, 10 mm long, 12 mm from one to the next, all of one mesh.
class BoxesInARow : public ::testing::Test {
 protected:
  BoxesInARow() {
    const auto box = SharedBox(10, 10, 10);
    layout_ = LayoutOf(std::vector<core::SharedMesh>(9, box));
    for (int i = 0; i < 9; ++i) poses_.push_back(At(12.0 * i, 0, 0));
  }

  core::Layout layout_;
  std::vector<RigidTransform> poses_;
};

TEST_F(BoxesInARow, OnlyPairsWhoseBoundsAreNearAreAskedOfFcl) {
  ClashChecker checker(layout_, PairsOf(layout_, {}, 5.0).pairs);
  const ClashReport report = checker.Check(poses_);
  EXPECT_EQ(report.count.pairs, 36);
  EXPECT_EQ(report.count.settled_by_bounds, 28);
  EXPECT_EQ(report.count.collision_calls, 0);
  EXPECT_EQ(report.count.distance_calls, 8);
  EXPECT_EQ(report.count.unchanged, 0);
  for (const PairClash& pair : report.pairs) {
    EXPECT_EQ(pair.verdict, pair.demand.b == pair.demand.a + 1 ? Verdict::kNear : Verdict::kClear);
    EXPECT_EQ(pair.gap.has_value(), pair.verdict == Verdict::kNear);
    EXPECT_NEAR(pair.at_least_mm, 12.0 * static_cast<double>(pair.demand.b - pair.demand.a) - 10.0,
                kClashRoundingMm);
  }
}

TEST_F(BoxesInARow, OnlyPairsOfWhichAPartMovedAreAskedAgain) {
  ClashChecker checker(layout_, PairsOf(layout_, {}, 5.0).pairs);
  (void)checker.Check(poses_);
  ClashReport report = checker.Check(poses_);
  EXPECT_EQ(report.count.unchanged, 36);
  EXPECT_EQ(report.count.settled_by_bounds, 0);
  EXPECT_EQ(report.count.distance_calls, 0);
  poses_[8].translation_mm.x() -= 4.0;  // into its neighbour
  report = checker.Check(poses_);
  EXPECT_EQ(report.count.unchanged, 28);
  EXPECT_EQ(report.count.settled_by_bounds, 7);
  EXPECT_EQ(report.count.collision_calls, 1);
  EXPECT_EQ(report.count.distance_calls, 0);
  ClashChecker fresh(layout_, PairsOf(layout_, {}, 5.0).pairs);
  const ClashReport anew = fresh.Check(poses_);
  for (std::size_t i = 0; i < anew.pairs.size(); ++i) {
    EXPECT_EQ(report.pairs[i].verdict, anew.pairs[i].verdict);
    EXPECT_EQ(report.pairs[i].at_least_mm, anew.pairs[i].at_least_mm);
  }
  EXPECT_EQ(anew.count.collision_calls + anew.count.distance_calls, 8);
}

TEST_F(BoxesInARow, ACancelledCheckLeavesTheLastAnswers) {
  ClashChecker checker(layout_, PairsOf(layout_, {}, 5.0).pairs);
  (void)checker.Check(poses_);
  std::stop_source source;
  source.request_stop();
  auto moved = poses_;
  moved[0].translation_mm.y() = 1.0;
  EXPECT_THROW((void)checker.Check(moved, {}, source.get_token()), core::Error);
  EXPECT_EQ(checker.Check(poses_).count.unchanged, 36);
  EXPECT_EQ(checker.Check(moved).count.unchanged, 28);
}

TEST_F(BoxesInARow, ProgressEndsWithAllPairs) {
  std::int64_t last_done = 0, last_total = 0;
  ClashChecker checker(layout_, PairsOf(layout_).pairs);
  (void)checker.Check(poses_, core::Progress([&](std::int64_t done, std::int64_t total, const std::string&) {
                        last_done = done;
                        last_total = total;
                      }));
  EXPECT_EQ(last_done, 36);
  EXPECT_EQ(last_total, 36);
}

TEST(Clash, OneThreadFindsWhatManyFind) {
  std::mt19937_64 random(3);
  std::vector<core::SharedMesh> meshes;
  std::vector<RigidTransform> poses;
  for (int i = 0; i < 24; ++i) {
    meshes.push_back(Shared(MakePart(static_cast<testing::PartKind>(i % 6), random)));
    poses.push_back(testing::AnyPose(random, 50.0));
  }
  const core::Layout layout = LayoutOf(meshes);
  const auto check = [&](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    ClashChecker checker(layout, PairsOf(layout, {}, 10.0).pairs);
    return checker.Check(poses);
  };
  const ClashReport one = check(1), many = check(4);
  EXPECT_EQ(one.count.distance_calls, many.count.distance_calls);
  for (std::size_t i = 0; i < one.pairs.size(); ++i) {
    EXPECT_EQ(one.pairs[i].verdict, many.pairs[i].verdict);
    ASSERT_EQ(one.pairs[i].gap.has_value(), many.pairs[i].gap.has_value());
    if (!one.pairs[i].gap) continue;
    EXPECT_EQ(one.pairs[i].gap->distance_mm, many.pairs[i].gap->distance_mm);
    EXPECT_EQ(one.pairs[i].gap->on_a, many.pairs[i].gap->on_a);
  }
}

}  // namespace
}  // namespace elbowroom::review
