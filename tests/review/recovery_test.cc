// Recovery against closed forms on a box, and its traps.
#include "review/recovery.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include "core/error.h"
#include "recon/contours/silhouette.h"
#include "recon/hull/visual_hull.h"
#include "recon/paper_methods/coverage_hull.h"
#include "review/contacts.h"
#include "review/paper_methods/two_triangle_response.h"
#include "tests/core/solids.h"
#include "tests/recon/scenes/random_scene.h"
#include "tests/review/box_hull.h"

namespace elbowroom::review {
namespace {

using core::RecoveryKind;
using core::RecoveryStatus;
using Eigen::Vector3d;
using recon::Random;
using recon::VisualHull;

constexpr double kRoundingMm = 1e-5;
constexpr double kQuarterTurnRad = 0.5 * std::numbers::pi;

RecoveryAnswer Towards(const Vector3d& cp_obj, const Vector3d& rp_obj) {
  return Recover(BoxHull(), cp_obj, {.rp_obj = rp_obj});
}
RecoveryAnswer Along(RecoveryKind kind, const Vector3d& cp_obj, const Vector3d& axis) {
  return Recover(BoxHull(), cp_obj, {.kind = kind, .axis = axis.normalized()});
}

recon::CoverageHull TexturesOf(const VisualHull& hull) {
  std::vector<core::SoftMask> masks;
  for (const auto& silhouette : hull.silhouettes()) masks.push_back(silhouette->soft_mask());
  return {hull.rig(), masks};
}

TEST(Recovery, EightyMillimetresDeepWhereTheYardstickGivesUp) {
  const VisualHull hull = BoxHull();
  const Vector3d cp_obj(-30, 5, -8), rp_obj(120, 5, -8);
  const RecoveryAnswer answer = Recover(hull, cp_obj, {.rp_obj = rp_obj});
  ASSERT_EQ(answer.status, RecoveryStatus::kFound);
  EXPECT_NEAR(answer.recovery->d_rec_mm, 80.0, kBoxHullMm);
  EXPECT_NEAR(answer.recovery->cp_hull_in_world_mm.x(), 50.0, kBoxHullMm);
  EXPECT_LT((answer.recovery->n_hull_in_world.value() - Vector3d::UnitX()).norm(), 1e-3);
  const TwoTriangleResponse yardstick = RespondByTwoTriangles(TexturesOf(hull), std::vector{cp_obj}, rp_obj);
  EXPECT_EQ(yardstick.status, TwoTriangleStatus::kDeeperThanTriangle);
  EXPECT_FALSE(yardstick.recovery);
}

TEST(Recovery, ReferenceInsideTheHullIsPassed) {
  const RecoveryAnswer answer = Towards({-30, 0, 0}, {20, 0, 0});
  ASSERT_EQ(answer.status, RecoveryStatus::kReferenceInsideHull);
  EXPECT_EQ(answer.recovery->v_rec_in_world, Vector3d::UnitX());
  EXPECT_NEAR(answer.recovery->d_rec_mm, 80.0, kBoxHullMm) << "on past RP_obj, which is 50 mm away";
}

TEST(Recovery, NoLengthIsNoDirection) {
  const RecoveryAnswer answer = Towards({1, 2, 3}, {1, 2, 3});
  EXPECT_EQ(answer.status, RecoveryStatus::kNoDirection);
  EXPECT_FALSE(answer.recovery);
}

TEST(Recovery, NoExitWhereOnlyTheWorkspaceEndsTheWay) {
  const VisualHull hull = FullHull();
  const double to_face_mm = hull.rig().workspace_mm.max().x();
  const std::vector<RecoveryWay> ways = {{.rp_obj = {500, 0, 0}},  // outside of the workspace
                                         {.rp_obj = {60, 0, 0}},   // inside the hull
                                         {.kind = RecoveryKind::kDirection, .axis = Vector3d::UnitX()},
                                         {.kind = RecoveryKind::kSlider, .axis = -Vector3d::UnitX()}};
  for (const RecoveryWay& way : ways) {
    const RecoveryAnswer answer = Recover(hull, {10, 0, 0}, way);
    EXPECT_EQ(answer.status, RecoveryStatus::kNoExit);
    ASSERT_TRUE(answer.recovery);
    EXPECT_NEAR(answer.recovery->d_rec_mm, to_face_mm - 10.0, kRoundingMm) << "a lower bound";
    EXPECT_FALSE(answer.recovery->n_hull_in_world) << "a face isn't the hull's surface";
  }
}

TEST(Recovery, OnTheSurfaceThereIsNothingToRecover) {
  const RecoveryAnswer direction = Along(RecoveryKind::kDirection, {0, 0, 30}, Vector3d::UnitX());
  const Vector3d on_surface = direction.recovery->cp_hull_in_world_mm;
  for (const RecoveryAnswer& answer :
       {Towards(on_surface, {120, 0, 30}), Along(RecoveryKind::kDirection, on_surface, Vector3d::UnitX()),
        Along(RecoveryKind::kSlider, on_surface, Vector3d::UnitX())}) {
    EXPECT_EQ(answer.status, RecoveryStatus::kOnSurface);
    EXPECT_NEAR(answer.recovery->d_rec_mm, 0.0, kRoundingMm);
    EXPECT_LT((answer.recovery->cp_hull_in_world_mm - on_surface).norm(), kRoundingMm);
    EXPECT_TRUE(answer.recovery->n_hull_in_world);
  }
}

TEST(Recovery, DirectionKeepsItsSenseAndASliderTakesTheShorter) {
  const RecoveryAnswer kept = Along(RecoveryKind::kDirection, {30, 0, 0}, -Vector3d::UnitX());
  ASSERT_EQ(kept.status, RecoveryStatus::kFound);
  EXPECT_NEAR(kept.recovery->d_rec_mm, 80.0, kBoxHullMm);
  const RecoveryAnswer shorter = Along(RecoveryKind::kSlider, {30, 0, 0}, -Vector3d::UnitX());
  ASSERT_EQ(shorter.status, RecoveryStatus::kFound);
  EXPECT_EQ(shorter.recovery->v_rec_in_world, Vector3d::UnitX());
  EXPECT_NEAR(shorter.recovery->d_rec_mm, 20.0, kBoxHullMm);
  EXPECT_LT((shorter.recovery->n_hull_in_world.value() - Vector3d::UnitX()).norm(), 1e-3);
}

TEST(Recovery, HingeTurnsOutByTheShorterArc) {
  // About z through (50, -20, 0): the point stands 60 mm along y from it, 10 mm deep on the arc's side.
  const double radius_mm = 60.0;
  RecoveryWay way{.kind = RecoveryKind::kHinge, .axis = Vector3d::UnitZ(), .at_mm = {50, -20, 7}};
  const double start_rad = 0.1;  // beyond the face x = 50, turned into the box
  const Vector3d cp_obj(50 - radius_mm * std::sin(start_rad), -20 + radius_mm * std::cos(start_rad), 0);
  const RecoveryAnswer answer = Recover(BoxHull(), cp_obj, way);
  ASSERT_EQ(answer.status, RecoveryStatus::kFound);
  const core::Recovery& recovery = *answer.recovery;
  ASSERT_TRUE(recovery.angle_rad);
  EXPECT_NEAR(*recovery.angle_rad, -start_rad, kBoxHullMm / radius_mm);
  EXPECT_NEAR(recovery.d_rec_mm, radius_mm * start_rad, kBoxHullMm);
  EXPECT_NEAR(recovery.cp_hull_in_world_mm.x(), 50.0, kBoxHullMm);
  EXPECT_NEAR((recovery.cp_hull_in_world_mm - Vector3d(50, -20, 0)).norm(), radius_mm, kRoundingMm);
  EXPECT_LT((recovery.v_rec_in_world - Vector3d(std::cos(start_rad), std::sin(start_rad), 0)).norm(), 1e-9);
  EXPECT_LT((recovery.n_hull_in_world.value() - Vector3d::UnitX()).norm(), 1e-3);
  // The other sense of the axis is the same hinge.
  way.axis = -way.axis;
  EXPECT_NEAR(Recover(BoxHull(), cp_obj, way).recovery->angle_rad.value(), start_rad, kBoxHullMm / radius_mm);
}

TEST(Recovery, HingeWithoutAWayOut) {
  const RecoveryWay hinge{.kind = RecoveryKind::kHinge, .axis = Vector3d::UnitZ(), .at_mm = {0, 0, 0}};
  const RecoveryAnswer circling = Recover(BoxHull(), {20, 0, 0}, hinge);
  EXPECT_EQ(circling.status, RecoveryStatus::kNoExit) << "its whole circle is in the hull";
  EXPECT_FALSE(circling.recovery);
  EXPECT_EQ(Recover(BoxHull(), {0, 0, 30}, hinge).status, RecoveryStatus::kNoDirection) << "on the axis";
  const RecoveryAnswer to_face =
      Recover(FullHull(), {90, 0, 0}, {RecoveryKind::kHinge, {}, Vector3d::UnitZ(), {50, 60, 0}});
  EXPECT_EQ(to_face.status, RecoveryStatus::kNoExit);
  ASSERT_TRUE(to_face.recovery);
  EXPECT_NEAR(to_face.recovery->cp_hull_in_world_mm.cwiseAbs().maxCoeff(), 95.0, kRoundingMm);
}

TEST(Recovery, AWayOutIsBetterThanTheEndOfTheWorkspace) {
  // In a bar that reaches the workspace's faces along x, seen by the camera along z alone.
  const VisualHull full = FullHull();
  std::vector<core::BitMask> masks;
  for (const auto& silhouette : full.silhouettes()) masks.push_back(silhouette->mask());
  for (int y = 0; y < 200; ++y)
    for (int x = 0; x < 200; ++x) masks[2].Set(x, y, std::abs(x - 99.5) < 20.0);
  const VisualHull bar = recon::MakeVisualHull(full.shared_rig(), masks);
  const bool is_across_x = !bar.Contains({60, 0, 0});
  const Vector3d across = is_across_x ? Vector3d::UnitX() : Vector3d::UnitY();
  const Vector3d along = is_across_x ? Vector3d::UnitY() : Vector3d::UnitX();
  const Vector3d at = 90.0 * along;  // 5 mm to the face; the bar ends 20 mm across
  const Vector3d slanted = (along + 0.2 * across).normalized();
  const RecoveryAnswer answer = Recover(bar, at, {.kind = RecoveryKind::kSlider, .axis = slanted});
  ASSERT_EQ(answer.status, RecoveryStatus::kFound);
  EXPECT_EQ(answer.recovery->v_rec_in_world, -slanted) << "the longer sense, but it ends outside the hull";
  EXPECT_NEAR(answer.recovery->d_rec_mm, 20.0 / slanted.dot(across), 5.0 * kBoxHullMm);
}

TEST(Recovery, FollowsThePartsOwnFrame) {
  Random random(7201);
  const core::TriangleTree part(
      std::make_shared<const core::TriangleMesh>(core::testing::Box(Vector3d(10, 20, 30))));
  const core::RigidTransform world_from_part{random.Rotation(), Vector3d(3, 4, 5)};
  const core::RecoveryRule hinge{RecoveryKind::kHinge, Vector3d(1, 2, 3), Vector3d(0, 0, 5),
                                 Vector3d(9, 9, 9)};
  const RecoveryWay way = WayOf(hinge, part, world_from_part);
  EXPECT_EQ(way.rp_obj, world_from_part * Vector3d(1, 2, 3));
  EXPECT_LT((way.axis - world_from_part.rotation.col(2)).norm(), 1e-15);
  EXPECT_EQ(way.at_mm, world_from_part * Vector3d(9, 9, 9));
  EXPECT_LT((WayOf({}, part, world_from_part).rp_obj - world_from_part * Vector3d(5, 10, 15)).norm(), 1e-12)
      << "the centre of the bounds";
}

TEST(Recovery, ContactsFollowTheRule) {
  const core::TriangleTree part(
      std::make_shared<const core::TriangleMesh>(core::testing::Box(Vector3d::Constant(40.0))));
  const core::RigidTransform world_from_part{Eigen::Matrix3d::Identity(), Vector3d(40, -20, -20)};
  ContactOptions options;
  options.recovery = {RecoveryKind::kSlider, {}, Vector3d(3, 0, 0), {}};
  const core::PartContact contact = FindContacts(BoxHull(), part, world_from_part, 0, options);
  ASSERT_EQ(contact.recovery_status, RecoveryStatus::kFound);
  EXPECT_EQ(contact.recovery->v_rec_in_world, Vector3d::UnitX());
  EXPECT_NEAR(contact.recovery->d_rec_mm, 10.0, contact.resolution_mm);
}

TEST(RecoveryRule, SaysWhatIsMissingOrTooMuch) {
  using core::RecoveryRule;
  const Vector3d axis(0, 0, 1), at(1, 2, 3);
  for (const RecoveryRule& good :
       {RecoveryRule{}, RecoveryRule{RecoveryKind::kReference, at, {}, {}},
        RecoveryRule{RecoveryKind::kDirection, {}, axis, {}},
        RecoveryRule{RecoveryKind::kSlider, at, axis, {}}, RecoveryRule{RecoveryKind::kHinge, {}, axis, at}})
    EXPECT_FALSE(good.BrokenRule()) << core::ToString(good.kind);
  for (const RecoveryRule& bad :
       {RecoveryRule{RecoveryKind::kDirection, {}, {}, {}},
        RecoveryRule{RecoveryKind::kReference, {}, axis, {}},
        RecoveryRule{RecoveryKind::kSlider, {}, Vector3d(0, 0, 0), {}},
        RecoveryRule{RecoveryKind::kSlider, {}, axis, at}, RecoveryRule{RecoveryKind::kHinge, {}, axis, {}},
        RecoveryRule{RecoveryKind::kHinge, {}, {}, at},
        RecoveryRule{RecoveryKind::kReference, Vector3d::Constant(std::nan("")), {}, {}}})
    EXPECT_TRUE(bad.BrokenRule()) << core::ToString(bad.kind);
  for (const RecoveryKind kind :
       {RecoveryKind::kReference, RecoveryKind::kDirection, RecoveryKind::kSlider, RecoveryKind::kHinge})
    EXPECT_EQ(core::ParseRecoveryKind(core::ToString(kind)), kind);
  EXPECT_FALSE(core::ParseRecoveryKind("sideways"));
}

}  // namespace
}  // namespace elbowroom::review
