// Skipping never changes a result.
#include "app/control/frame_pipeline.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "app/control/demo_parts.h"
#include "recon/hull/visual_hull.h"
#include "recon/synthetic/demo_motion.h"
#include "recon/synthetic/rig_presets.h"
#include "recon/synthetic/synthetic_rig.h"

namespace elbowroom::control {
namespace {

// The demo's rig with exact masks in place of pictures.
class FramePipelineTest : public testing::Test {
 protected:
  FramePipelineTest()
      : source_(recon::FourCameraRig(), [](double time_s) { return recon::DemoSceneAt(time_s).objects; }) {}

  recon::FrameSet MasksOf(core::FrameIndex index) const {
    recon::FrameSet frames;
    frames.index = index;
    frames.time_s = source_.TimeOfFrameS(index);
    for (core::BitMask& mask : source_.TrueMasks(source_.ObjectsAt(index)))
      frames.cameras.push_back({{}, std::move(mask)});
    return frames;
  }
  FramePipeline MakePipeline(double required_mm = 0.0, const core::Layout& layout = DemoLayout()) const {
    review::PartReviewOptions review;
    review.required_clearance_mm = required_mm;
    return {source_.rig(), layout, std::vector<recon::BackgroundReference>(4), {}, review};
  }

  recon::SyntheticRig source_;
};

// The frame set with a stamp for each camera: camera i looks i * 7 ms before the set's time.
recon::FrameSet Stamped(recon::FrameSet frames) {
  for (std::size_t i = 0; i < frames.cameras.size(); ++i)
    frames.cameras[i].stamp = core::CameraStamp{static_cast<std::uint64_t>(frames.index) + i,
                                                frames.time_s - 7e-3 * static_cast<double>(i)};
  return frames;
}

constexpr core::FrameIndex kTouching = 60;  // the pipe is being lowered

void ExpectSameContacts(const FrameResult& a, const FrameResult& b) {
  ASSERT_EQ(a.record.contacts.size(), b.record.contacts.size());
  for (std::size_t i = 0; i < a.record.contacts.size(); ++i) {
    EXPECT_EQ(a.record.contacts[i].verdict, b.record.contacts[i].verdict);
    EXPECT_EQ(a.record.contacts[i].contact_area_mm2, b.record.contacts[i].contact_area_mm2);
    EXPECT_EQ(a.record.contacts[i].contact_point_count, b.record.contacts[i].contact_point_count);
  }
}

TEST_F(FramePipelineTest, AnUnchangedFrameIsNotComputedAgain) {
  FramePipeline pipeline = MakePipeline();
  const std::vector<double> gap = {kGapInitialMm};
  const SharedFrameResult first = pipeline.Process(MasksOf(kTouching), gap);
  const SharedFrameResult again = pipeline.Process(MasksOf(kTouching), gap);
  EXPECT_EQ(first->skipped.hull.unchanged_silhouettes, 0);
  EXPECT_EQ(again->skipped.hull.unchanged_silhouettes, 4);
  EXPECT_EQ(again->skipped.unchanged_parts, 3);
  EXPECT_EQ(again->skipped.queries, 0);
  EXPECT_EQ(again->hull, first->hull);
  ExpectSameContacts(*first, *again);
}

TEST_F(FramePipelineTest, TheRecordKeepsTheStampsOfTheFrameSet) {
  FramePipeline pipeline = MakePipeline();
  const std::vector<double> gap = {kGapInitialMm};
  EXPECT_TRUE(pipeline.Process(MasksOf(kTouching), gap)->record.stamps.empty());
  recon::FrameSet frames = Stamped(MasksOf(kTouching));
  const SharedFrameResult result = pipeline.Process(frames, gap);
  ASSERT_EQ(result->record.stamps.size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(result->record.stamps[i], frames.cameras[i].stamp);
}

TEST_F(FramePipelineTest, WithoutACameraATouchIsUndecidedAndClearStaysClear) {
  FramePipeline pipeline = MakePipeline(15.0);
  const std::vector<double> gap = {kGapInitialMm};
  const SharedFrameResult whole = pipeline.Process(Stamped(MasksOf(kTouching)), gap);
  ASSERT_EQ(whole->record.contacts[1].verdict, core::Verdict::kContact);
  int clear = 0;
  for (std::size_t missing = 0; missing < 4; ++missing) {
    recon::FrameSet frames = Stamped(MasksOf(kTouching));
    frames.cameras[missing] = {};
    const SharedFrameResult result = pipeline.Process(frames, gap);
    EXPECT_TRUE(result->record.LacksCamera());
    EXPECT_EQ((*result->record.masks)[missing].mask.CountObjectPixels(), 640U * 480U);
    EXPECT_EQ(result->record.contacts[1].verdict, core::Verdict::kUndecided);
    EXPECT_GT(result->record.contacts[1].contact_point_count, 0) << "the evidence stays";
    for (std::size_t i = 0; i < 3; ++i) {
      const core::PartContact& contact = result->record.contacts[i];
      if (contact.verdict != core::Verdict::kClear) continue;
      ++clear;
      EXPECT_EQ(whole->record.contacts[i].verdict, core::Verdict::kClear) << missing;
    }
  }
  EXPECT_GT(clear, 0);
}

// A camera whose lens is covered shows all object, too, but it isn't missing.
TEST_F(FramePipelineTest, AnEqualHullThatLackedACameraIsJudgedAgain) {
  FramePipeline pipeline = MakePipeline();
  const std::vector<double> gap = {kGapInitialMm};
  recon::FrameSet lacking = Stamped(MasksOf(kTouching)), covered = lacking;
  lacking.cameras[0] = {};
  covered.cameras[0].ready_mask->SetAll();
  const SharedFrameResult first = pipeline.Process(lacking, gap);
  const SharedFrameResult again = pipeline.Process(lacking, gap);
  EXPECT_EQ(again->hull, first->hull);
  EXPECT_EQ(again->skipped.unchanged_parts, 3);
  EXPECT_EQ(again->record.contacts[1].verdict, core::Verdict::kUndecided);
  const SharedFrameResult seen = pipeline.Process(covered, gap);
  EXPECT_EQ(seen->hull, first->hull);
  EXPECT_EQ(seen->skipped.unchanged_parts, 0);
  EXPECT_EQ(seen->record.contacts[1].verdict, core::Verdict::kContact);
  EXPECT_EQ(pipeline.Process(lacking, gap)->record.contacts[1].verdict, core::Verdict::kUndecided);
}

double LargestSkewMm(const FrameResult& result) {
  double largest_mm = 0.0;
  for (const core::PartContact& contact : result.record.contacts)
    largest_mm = std::max(largest_mm, contact.clearance->budget->skew_mm);
  return largest_mm;
}

TEST_F(FramePipelineTest, SkewTimesSpeedIsAllowedForAndAHullThatStopsIsJudgedAgain) {
  FramePipeline pipeline = MakePipeline(15.0);
  const std::vector<double> gap = {kGapInitialMm};
  const auto show = [&](core::FrameIndex masks_of, core::FrameIndex as_frame) {
    recon::FrameSet frames = MasksOf(masks_of);
    frames.index = as_frame;
    frames.time_s = source_.TimeOfFrameS(as_frame);
    return pipeline.Process(Stamped(std::move(frames)), gap);
  };
  (void)show(kTouching - 40, 0);
  (void)show(kTouching - 20, 1);
  const SharedFrameResult moving = show(kTouching, 2);
  EXPECT_GT(LargestSkewMm(*moving), 0.1);
  EXPECT_EQ(moving->record.contacts[0].clearance->budget->given_mm, 0.0);
  const SharedFrameResult stopped = show(kTouching, 3);
  EXPECT_EQ(stopped->hull, moving->hull);
  EXPECT_EQ(LargestSkewMm(*stopped), 0.0);
  EXPECT_EQ(stopped->skipped.unchanged_parts, 0) << "the moving hull's answers allowed for more";
  const SharedFrameResult still = show(kTouching, 4);
  EXPECT_EQ(still->skipped.unchanged_parts, 3);
  EXPECT_EQ(LargestSkewMm(*still), 0.0);
}

TEST_F(FramePipelineTest, WithoutStampsOrARequiredClearanceNothingIsSaidOfSkew) {
  const std::vector<double> gap = {kGapInitialMm};
  FramePipeline unstamped = MakePipeline(15.0), contact_only = MakePipeline();
  for (const core::FrameIndex frame : {kTouching - 1, kTouching}) {
    const SharedFrameResult result = unstamped.Process(MasksOf(frame), gap);
    EXPECT_EQ(result->skew_errors, nullptr);
    for (const core::PartContact& contact : result->record.contacts)
      EXPECT_FALSE(contact.clearance->budget.has_value());
    EXPECT_EQ(contact_only.Process(Stamped(MasksOf(frame)), gap)->skew_errors, nullptr);
  }
}

TEST_F(FramePipelineTest, WhatNeedsNoMoreThanTheHullRunsBeside) {
  FramePipeline alone = MakePipeline(15.0), beside = MakePipeline(15.0);
  const std::vector<double> gap = {kGapInitialMm};
  for (const core::FrameIndex frame : {kTouching - 1, kTouching, kTouching}) {
    std::vector<std::shared_ptr<const recon::VisualHull>> seen;
    const SharedFrameResult result =
        beside.Process(MasksOf(frame), gap, [&](const auto& hull) { seen.push_back(hull); });
    ASSERT_EQ(seen.size(), 1U);
    EXPECT_EQ(seen[0], result->hull);
    ExpectSameContacts(*result, *alone.Process(MasksOf(frame), gap));
  }
}

TEST_F(FramePipelineTest, OnlyTheMovedPartIsAskedAgain) {
  FramePipeline pipeline = MakePipeline();
  const SharedFrameResult at_140 = pipeline.Process(MasksOf(kTouching), std::vector<double>{kGapInitialMm});
  const SharedFrameResult at_240 = pipeline.Process(MasksOf(kTouching), std::vector<double>{kGapNeededMm});
  EXPECT_EQ(at_140->record.contacts[1].verdict, core::Verdict::kContact);
  EXPECT_EQ(at_240->record.contacts[1].verdict, core::Verdict::kClear);
  EXPECT_EQ(at_240->skipped.unchanged_parts, 2);
}

TEST_F(FramePipelineTest, WhatCameBeforeDoesntChangeAFrame) {
  FramePipeline warm = MakePipeline();
  const std::vector<double> gap = {kGapInitialMm};
  for (const core::FrameIndex frame : {kTouching - 2, kTouching - 2, kTouching - 1})
    (void)warm.Process(MasksOf(frame), gap);
  FramePipeline cold = MakePipeline();
  ExpectSameContacts(*warm.Process(MasksOf(kTouching), gap), *cold.Process(MasksOf(kTouching), gap));
}

TEST_F(FramePipelineTest, PartsGiveWayAsTheirLayoutSays) {
  core::Layout layout = DemoLayout();
  for (core::Part& part : layout.parts)
    part.recovery = {core::RecoveryKind::kSlider, {}, Eigen::Vector3d(0, 2, 0), {}};
  FramePipeline pipeline(source_.rig(), layout, std::vector<recon::BackgroundReference>(4), {});
  const std::vector<double> gap = {kGapInitialMm};
  int recovered = 0;
  for (core::FrameIndex frame = 0; frame < 3 * kTouching; frame += 20) {
    const SharedFrameResult result = pipeline.Process(MasksOf(frame), gap);
    for (std::size_t i = 0; i < result->record.contacts.size(); ++i) {
      const auto& recovery = result->record.contacts[i].recovery;
      if (!recovery) continue;
      ++recovered;
      const Eigen::Vector3d axis = result->world_from_parts[i].rotation.col(1);
      EXPECT_NEAR(std::abs(recovery->v_rec_in_world.dot(axis)), 1.0, 1e-12);
    }
  }
  EXPECT_GT(recovered, 0);
}

TEST_F(FramePipelineTest, AnEmptySceneTouchesNothingAndAsksNothing) {
  FramePipeline pipeline = MakePipeline();
  recon::FrameSet frames;
  for (int i = 0; i < 4; ++i) frames.cameras.push_back({{}, core::BitMask(640, 480)});
  const SharedFrameResult result = pipeline.Process(frames, std::vector<double>{kGapInitialMm});
  for (const core::PartContact& contact : result->record.contacts)
    EXPECT_EQ(contact.verdict, core::Verdict::kClear);
  EXPECT_EQ(result->skipped.queries, 0);
  EXPECT_EQ(result->skipped.hull.empty_silhouettes, 4);
  EXPECT_EQ(result->skipped.hull.untraced_silhouettes, 4);
}

TEST_F(FramePipelineTest, ClearanceIsAskedOnlyWhereItIsNotSettled) {
  core::Layout layout = DemoLayout();
  layout.parts[2].world_from_part.translation_mm.x() = -900.0;  // payload B, far from the hand
  FramePipeline pipeline = MakePipeline(20.0, layout);
  const std::vector<double> gap = {kGapInitialMm};
  const SharedFrameResult first = pipeline.Process(MasksOf(kTouching), gap);
  for (const core::PartContact& contact : first->record.contacts) ASSERT_TRUE(contact.clearance.has_value());
  EXPECT_EQ(first->record.contacts[1].verdict, core::Verdict::kContact);
  EXPECT_EQ(first->skipped.clearances_by_contact, 1);
  EXPECT_EQ(first->skipped.clearances_by_ball, 1);
  EXPECT_GT(first->skipped.clearance_queries, 2) << "the PMT box had to be searched for";
  const SharedFrameResult again = pipeline.Process(MasksOf(kTouching), gap);
  EXPECT_EQ(again->skipped.unchanged_parts, 3);
  EXPECT_EQ(again->skipped.clearance_queries, 0);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(again->record.contacts[i].verdict, first->record.contacts[i].verdict);
    EXPECT_EQ(again->record.contacts[i].clearance->interval.upper_mm,
              first->record.contacts[i].clearance->interval.upper_mm);
  }
}

TEST_F(FramePipelineTest, ClearanceWarmedByTheLastFrameIsAsTrue) {
  FramePipeline warm = MakePipeline(40.0);
  std::int64_t warm_queries = 0, cold_queries = 0;
  for (core::FrameIndex frame = kTouching - 20; frame < kTouching; ++frame) {
    const std::vector<double> gap = {kGapNeededMm};
    FramePipeline cold = MakePipeline(40.0);
    const SharedFrameResult a = warm.Process(MasksOf(frame), gap), b = cold.Process(MasksOf(frame), gap);
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_LE(a->record.contacts[i].clearance->interval.lower_mm,
                b->record.contacts[i].clearance->interval.upper_mm);
      EXPECT_LE(b->record.contacts[i].clearance->interval.lower_mm,
                a->record.contacts[i].clearance->interval.upper_mm);
    }
    warm_queries += a->skipped.clearance_queries;
    cold_queries += b->skipped.clearance_queries;
  }
  EXPECT_LT(warm_queries, cold_queries);
}

}  // namespace
}  // namespace elbowroom::control
