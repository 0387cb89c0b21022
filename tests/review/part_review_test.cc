// One part in one frame: contact, clearance and verdict agree with those who answer them one by one.
#include "review/part_review.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <optional>
#include <vector>

#include "core/error.h"
#include "core/infinity.h"
#include "recon/hull/visual_hull.h"
#include "tests/core/solids.h"
#include "tests/recon/scenes/random_scene.h"
#include "tests/review/box_hull.h"
#include "tests/support/soak.h"

namespace elbowroom::review {
namespace {

using Eigen::Vector3d;

using core::kInfinity;
constexpr double kReviewRoundingMm = 1e-6;

core::TriangleTree BoxTree(const Vector3d& center, const Vector3d& size_mm) {
  return core::TriangleTree(std::make_shared<const core::TriangleMesh>(
      core::Transformed(core::testing::Box(size_mm), {Eigen::Matrix3d::Identity(), center - 0.5 * size_mm})));
}

PartReviewOptions Requiring(double required_mm, double uncertainty_mm = 0.0) {
  PartReviewOptions options;
  options.required_clearance_mm = required_mm;
  options.uncertainty_mm = uncertainty_mm;
  return options;
}

core::PartContact Review(double gap_mm, const PartReviewOptions& options) {
  return ReviewPart(BoxHull(), BoxTree({60.0 + gap_mm, 0.0, 0.0}, {20.0, 20.0, 20.0}), {}, 4, options);
}

TEST(ReviewPart, OfABoxBesideABox) {
  EXPECT_EQ(Review(10.0, Requiring(20.0)).verdict, core::Verdict::kNear);
  EXPECT_EQ(Review(30.0, Requiring(20.0)).verdict, core::Verdict::kClear);
  EXPECT_EQ(Review(20.5, Requiring(20.0, 2.0)).verdict, core::Verdict::kUndecided);
  EXPECT_EQ(Review(-5.0, Requiring(20.0)).verdict, core::Verdict::kContact);
  EXPECT_EQ(Review(10.0, Requiring(20.0)).part, 4U);
}

TEST(ReviewPart, WithoutARequiredClearanceOnlyContactIsAsked) {
  const core::PartContact near = Review(5.0, {});
  EXPECT_FALSE(near.clearance.has_value());
  EXPECT_EQ(near.verdict, core::Verdict::kClear);
  EXPECT_EQ(Review(-5.0, {}).verdict, core::Verdict::kContact);
}

TEST(ReviewPart, WithoutACameraOnlyClearIsSureAndTheEvidenceStays) {
  for (const double required_mm : {0.0, 20.0}) {
    PartReviewOptions options = Requiring(required_mm);
    const core::PartContact with_all = Review(-5.0, options);
    options.lacks_camera = true;
    const core::PartContact touched = Review(-5.0, options);
    EXPECT_EQ(touched.verdict, core::Verdict::kUndecided);
    EXPECT_GT(touched.contact_point_count, 0);
    EXPECT_EQ(touched.contact_point_count, with_all.contact_point_count);
    EXPECT_EQ(touched.deepest->depth_mm, with_all.deepest->depth_mm);
    EXPECT_EQ(touched.recovery->d_rec_mm, with_all.recovery->d_rec_mm);
    EXPECT_EQ(Review(30.0, options).verdict, core::Verdict::kClear);
    const auto between = required_mm > 0.0 ? core::Verdict::kUndecided : core::Verdict::kClear;
    EXPECT_EQ(Review(10.0, options).verdict, between);
  }
}

// In the first frame nothing is known of the hull's speed.
PartReviewOptions OfAFirstFrame(double required_mm, double uncertainty_mm, double skew_s) {
  PartReviewOptions options = Requiring(required_mm, uncertainty_mm);
  recon::CameraLook look;
  look.skew_s = skew_s;
  std::vector<std::optional<recon::CameraLook>> looks(BoxHull().silhouettes().size(), look);
  options.skew_errors = std::make_shared<const recon::SkewErrors>(std::move(looks));
  return options;
}

TEST(ReviewPart, AllowsForSkewBesideWhatTheTrialGives) {
  constexpr double kSkewS = 0.001;  // 2 mm at the fastest
  const core::PartContact near = Review(18.0, OfAFirstFrame(20.0, 3.0, kSkewS));
  ASSERT_TRUE(near.clearance->budget.has_value());
  EXPECT_EQ(near.clearance->budget->given_mm, 1.5);
  EXPECT_GE(near.clearance->budget->skew_mm, recon::kFastestMmPerS * kSkewS);
  EXPECT_EQ(near.clearance->budget->calibration_mm, 0.0);
  EXPECT_EQ(near.verdict, core::Verdict::kUndecided) << "2 mm nearer than required, 5 mm allowed for";
  EXPECT_EQ(Review(18.0, OfAFirstFrame(20.0, 0.0, 0.0)).verdict, core::Verdict::kNear);
  EXPECT_EQ(Review(40.0, OfAFirstFrame(20.0, 3.0, kSkewS)).verdict, core::Verdict::kClear);
  EXPECT_EQ(Review(23.0, OfAFirstFrame(20.0, 0.0, kSkewS)).verdict, core::Verdict::kUndecided);
  EXPECT_EQ(Review(23.0, Requiring(20.0)).verdict, core::Verdict::kClear);
  EXPECT_EQ(Review(-5.0, OfAFirstFrame(20.0, 0.0, kSkewS)).verdict, core::Verdict::kContact);
}

TEST(ReviewPart, ContactNeedsNoSearch) {
  const core::PartContact contact = Review(-5.0, Requiring(20.0));
  ASSERT_TRUE(contact.clearance.has_value());
  EXPECT_EQ(contact.clearance->interval.upper_mm, 0.0);
  EXPECT_EQ(contact.clearance->queries, 0);
  EXPECT_EQ(contact.clearance->interval.witness_hull_in_world_mm, contact.deepest->position_in_world_mm);
}

TEST(ReviewPart, HullInsideAPartIsShownByItsPoint) {
  const core::PartContact contact =
      ReviewPart(BoxHull(), BoxTree(Vector3d::Zero(), {180.0, 180.0, 180.0}), {}, 0, Requiring(20.0));
  EXPECT_EQ(contact.verdict, core::Verdict::kContact);
  ASSERT_TRUE(contact.contained_in_world_mm.has_value());
  EXPECT_EQ(contact.clearance->interval.witness_hull_in_world_mm, *contact.contained_in_world_mm);
}

TEST(ReviewPart, AFarPartIsSettledByOneBall) {
  const core::PartContact contact =
      ReviewPart(BoxHull(), BoxTree({88.0, 0.0, 0.0}, {2.0, 2.0, 2.0}), {}, 0, Requiring(20.0));
  EXPECT_EQ(contact.clearance->queries, 1);
  EXPECT_EQ(contact.clearance->interval.lower_mm, Requiring(20.0).EnoughMm());
  EXPECT_EQ(contact.clearance->interval.upper_mm, kInfinity);
  EXPECT_EQ(contact.verdict, core::Verdict::kClear);
}

TEST(ReviewPart, AnEmptyHullIsClear) {
  const core::PartContact contact =
      ReviewPart(BoxHull(true), BoxTree({70.0, 0.0, 0.0}, {2.0, 2.0, 2.0}), {}, 0, Requiring(20.0));
  EXPECT_EQ(contact.verdict, core::Verdict::kClear);
  EXPECT_EQ(contact.clearance->interval.lower_mm, kInfinity);
}

// Memory that is kept from frame to frame, and the frames before, go into no answer: a trial, a replay and a
// sweep ask in other orders, and must agree.
TEST(ReviewPart, IsAFunctionOfThisFrameAlone) {
  recon::Random random(41);
  int near = 0;
  for (int run = 0; run < 6 * test_support::SoakScale(); ++run) {
    const recon::RandomScene scene = MakeRingScene(&random, random.Whole(2, 4), core::UnseenPolicy::kOutside);
    const recon::VisualHull hull = recon::MakeVisualHull(scene.rig, scene.masks);
    const core::TriangleTree part = BoxTree(Vector3d::Zero(), {40.0, 30.0, 20.0});
    core::RigidTransform pose{random.Rotation(), random.Uniform(60.0, 160.0) * random.Direction()};
    const Vector3d drift = 2.0 * random.Direction();
    const PartReviewOptions options = Requiring(60.0, 1.0);
    InsideCells inside(part);
    ReviewScratch scratch;
    for (int frame = 0; frame < 12; ++frame) {
      pose.translation_mm += drift;
      const core::PartContact kept = ReviewPart(hull, part, pose, 0, options, &inside, &scratch);
      const core::PartContact fresh = ReviewPart(hull, part, pose, 0, options);
      ASSERT_EQ(kept.verdict, fresh.verdict);
      ASSERT_EQ(kept.clearance->interval.lower_mm, fresh.clearance->interval.lower_mm);
      ASSERT_EQ(kept.clearance->interval.upper_mm, fresh.clearance->interval.upper_mm);
      ASSERT_EQ(kept.contact_area_mm2, fresh.contact_area_mm2);
      near += kept.verdict == core::Verdict::kNear ? 1 : 0;
    }
  }
  EXPECT_GT(near, 10);
}

TEST(ReviewPart, RefusesWhatMeansNothing) {
  for (double PartReviewOptions::*option :
       {&PartReviewOptions::required_clearance_mm, &PartReviewOptions::uncertainty_mm,
        &PartReviewOptions::tolerance_mm}) {
    for (const double value : {-1.0, std::nan(""), kInfinity}) {
      PartReviewOptions options;
      options.*option = value;
      EXPECT_THROW(options.Validate(), core::Error) << value;
    }
  }
}

}  // namespace
}  // namespace elbowroom::review
