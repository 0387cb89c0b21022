// The study against an oracle that asks every frame at every step and skips nothing.
#include "review/spacing_study.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "core/error.h"
#include "recon/hull/visual_hull.h"
#include "tests/core/solids.h"
#include "tests/recon/scenes/random_scene.h"
#include "tests/review/box_hull.h"
#include "tests/support/soak.h"

namespace elbowroom::review {
namespace {

using Eigen::Vector3d;

constexpr double kStudyRoundingMm = 1e-6;
constexpr core::PartIndex kMoving = 1, kRider = 2, kFixed = 3;

core::Part BoxPart(const std::string& name, const Vector3d& size_mm, const Vector3d& center_mm) {
  core::Part part;
  part.name = name;
  part.mesh = std::make_shared<const core::TriangleMesh>(
      core::Transformed(core::testing::Box(size_mm), {Eigen::Matrix3d::Identity(), -0.5 * size_mm}));
  part.world_from_part.translation_mm = center_mm;
  return part;
}

// A lid that moves over a base, a rider on the lid, a part that doesn't move.
core::Layout LidLayout() {
  core::Layout layout;
  layout.parts = {BoxPart("base", {60.0, 60.0, 10.0}, {0.0, 0.0, -85.0}),
                  BoxPart("lid", {50.0, 50.0, 6.0}, {0.0, 0.0, 0.0}),
                  BoxPart("rider", {10.0, 10.0, 10.0}, {20.0, 0.0, 40.0}),
                  BoxPart("fixed", {20.0, 20.0, 20.0}, {70.0, 0.0, 0.0})};
  layout.spacings = {{"gap", "lid", "base", core::Axis::kZ, 0.0, 300.0, 100.0},
                     {"ride", "rider", "lid", core::Axis::kZ, 0.0, 50.0, 5.0}};
  layout.Validate();
  return layout;
}

StudyFrames Shared(const std::vector<StudyFrame>& frames) {
  return {frames.size(), [&frames](std::size_t i) { return frames[i]; }};
}

std::vector<StudyFrame> RandomFrames(recon::Random* random, int count) {
  const recon::RandomScene first = MakeRingScene(random, random->Whole(2, 4), core::UnseenPolicy::kOutside);
  std::vector<StudyFrame> frames;
  for (int i = 0; i < count; ++i) {
    const recon::RandomScene scene =
        i == 0 ? first : MakeRingScene(random, random->Whole(2, 4), core::UnseenPolicy::kOutside);
    frames.push_back(
        {10 + i,
         std::make_shared<const recon::VisualHull>(recon::MakeVisualHull(scene.rig, scene.masks)),
         {999.0, random->Uniform(0.0, 20.0)}});
  }
  return frames;
}

// What ReviewPart says of one part at one spacing, frame by frame, with nothing known from elsewhere, and the
// least distance.
PartAtSpacing AskAll(const core::Layout& layout, const std::vector<StudyFrame>& frames, double spacing_mm,
                     core::PartIndex part, const PartReviewOptions& options) {
  const core::TriangleTree tree(layout.parts[part].mesh);
  PartAtSpacing sum;
  for (const StudyFrame& frame : frames) {
    const auto pose = core::PosesAt(layout, std::vector{spacing_mm, frame.spacing_mm[1]})[part];
    PartReviewOptions of_frame = options;
    of_frame.skew_errors = frame.skew_errors;
    const core::PartContact contact = ReviewPart(*frame.hull, tree, pose, part, of_frame);
    sum.frames_in_contact += contact.verdict == core::Verdict::kContact ? 1 : 0;
    sum.frames_near += contact.verdict == core::Verdict::kNear ? 1 : 0;
    sum.frames_undecided += contact.verdict == core::Verdict::kUndecided ? 1 : 0;
    sum.frames_clear += contact.verdict == core::Verdict::kClear ? 1 : 0;
    if (contact.deepest) sum.deepest_mm = std::max(sum.deepest_mm, contact.deepest->depth_mm);
    ClearanceOptions clearance_options;
    clearance_options.tolerance_mm = options.tolerance_mm;
    core::ClearanceInterval interval = FindClearance(*frame.hull, tree, pose, clearance_options).interval;
    if (contact.verdict == core::Verdict::kContact) interval.lower_mm = interval.upper_mm = 0.0;
    sum.lower_mm = std::min(sum.lower_mm, interval.lower_mm);
    sum.upper_mm = std::min(sum.upper_mm, interval.upper_mm);
  }
  return sum;
}

// Verdicts and depths are the same; the bounds hold one least distance between them, and both are as narrow
// as the tolerance.
void ExpectAgree(const PartAtSpacing& fast, const PartAtSpacing& slow, double tolerance_mm = 1.0) {
  EXPECT_EQ(fast.frames_in_contact, slow.frames_in_contact);
  EXPECT_EQ(fast.frames_near, slow.frames_near);
  EXPECT_EQ(fast.frames_undecided, slow.frames_undecided);
  EXPECT_EQ(fast.frames_clear, slow.frames_clear);
  EXPECT_EQ(fast.deepest_mm, slow.deepest_mm);
  EXPECT_LE(fast.lower_mm, slow.upper_mm + kStudyRoundingMm);
  EXPECT_LE(slow.lower_mm, fast.upper_mm + kStudyRoundingMm);
  if (std::isfinite(slow.upper_mm)) {
    EXPECT_LE(fast.upper_mm - fast.lower_mm, tolerance_mm + kStudyRoundingMm);
  }
}

SpacingStudyOptions From(double from_mm, double to_mm, double step_mm, double required_mm = 8.0) {
  SpacingStudyOptions options;
  options.from_mm = from_mm;
  options.to_mm = to_mm;
  options.step_mm = step_mm;
  options.review.required_clearance_mm = required_mm;
  options.review.uncertainty_mm = required_mm > 0.0 ? 0.5 : 0.0;
  return options;
}

TEST(StudySpacing, AllowsForTheSkewOfEachFrame) {
  recon::Random random(979);
  const core::Layout layout = LidLayout();
  const std::vector<StudyFrame> at_once = RandomFrames(&random, 8);
  std::vector<StudyFrame> skewed = at_once;
  for (StudyFrame& frame : skewed) {
    recon::CameraLook look;  // of a first frame
    look.skew_s = 0.005;
    std::vector<std::optional<recon::CameraLook>> looks(frame.hull->silhouettes().size(), look);
    frame.skew_errors = std::make_shared<const recon::SkewErrors>(std::move(looks));
  }
  const SpacingStudyOptions options = From(0.0, 190.0, 19.0);
  const SpacingStudy without = StudySpacing(layout, Shared(at_once), options);
  const SpacingStudy with = StudySpacing(layout, Shared(skewed), options);
  std::int64_t clear_without = 0, clear_with = 0;
  for (std::size_t step = 0; step < without.curves[0].steps.size(); ++step) {
    for (core::PartIndex part = 0; part < layout.parts.size(); ++part) {
      const PartAtSpacing &a = without.curves[0].steps[step].parts[part],
                          &b = with.curves[0].steps[step].parts[part];
      EXPECT_EQ(a.frames_in_contact, b.frames_in_contact) << "contact is what the hull shows";
      EXPECT_LE(b.frames_clear, a.frames_clear);
      clear_without += a.frames_clear;
      clear_with += b.frames_clear;
    }
  }
  EXPECT_LT(clear_with, clear_without);
  EXPECT_GT(clear_with, 0);
  EXPECT_EQ(with.curves[0].largest_touched_mm, without.curves[0].largest_touched_mm);
}

TEST(StudySpacing, AgreesWithAskingEveryFrameAtEveryStep) {
  recon::Random random(977);
  const core::Layout layout = LidLayout();
  std::int64_t contacts = 0, by_motion = 0;
  for (int trial = 0; trial < 4 * test_support::SoakScale(); ++trial) {
    SCOPED_TRACE(trial);
    const std::vector<StudyFrame> frames = RandomFrames(&random, 8);
    const SpacingStudyOptions options = From(0.0, 190.0, 19.0, trial % 2 == 0 ? 8.0 : 0.0);
    const SpacingStudy study = StudySpacing(layout, Shared(frames), options);
    ASSERT_EQ(study.curves[0].steps.size(), 11U);
    for (const StudyStep& step : study.curves[0].steps) {
      for (core::PartIndex part = 0; part < layout.parts.size(); ++part) {
        SCOPED_TRACE(layout.parts[part].name + " at " + std::to_string(step.spacing_mm));
        ExpectAgree(step.parts[part], AskAll(layout, frames, step.spacing_mm, part, options.review));
        contacts += step.parts[part].frames_in_contact;
      }
    }
    by_motion += study.count.settled_by_motion;
    EXPECT_EQ(study.moved, (std::vector<core::PartIndex>{kMoving, kRider}));
    EXPECT_EQ(study.count.unmoved, 8 * 2 * 10) << "frames, parts, all steps but one";
  }
  EXPECT_GT(contacts, 20);
  EXPECT_GT(by_motion, 8);
}

PartReviewOptions FineReview() {
  PartReviewOptions options;
  options.tolerance_mm = 0.005;
  return options;
}

// Contact of any moved part in any frame, or as good as.
bool Touches(const core::Layout& layout, const std::vector<StudyFrame>& frames, double spacing_mm) {
  return std::ranges::any_of(std::vector{kMoving, kRider}, [&](core::PartIndex part) {
    return AskAll(layout, frames, spacing_mm, part, FineReview()).upper_mm <= FineReview().tolerance_mm;
  });
}

TEST(StudySpacing, FindsTheSmallestSpacingWithoutContactBetweenTwoValuesThatShowIt) {
  recon::Random random(31);
  const core::Layout layout = LidLayout();
  int found = 0, left_open = 0;
  for (int trial = 0; trial < 6 * test_support::SoakScale(); ++trial) {
    SCOPED_TRACE(trial);
    const std::vector<StudyFrame> frames = RandomFrames(&random, 3);
    const SpacingStudyOptions options = From(0.0, 280.0, 20.0, 0.0);
    const SpacingStudy study = StudySpacing(layout, Shared(frames), options);
    if (!study.curves[0].largest_touched_mm || !study.curves[0].smallest_free_mm) continue;
    ++found;
    EXPECT_GT(*study.curves[0].smallest_free_mm, *study.curves[0].largest_touched_mm);
    const double between_mm = 0.5 * (*study.curves[0].smallest_free_mm + *study.curves[0].largest_touched_mm);
    if (*study.curves[0].smallest_free_mm - *study.curves[0].largest_touched_mm > options.tolerance_mm) {
      ++left_open;
      double least_mm = 1e9;
      for (const core::PartIndex part : {kMoving, kRider})
        least_mm = std::min(least_mm, AskAll(layout, frames, between_mm, part, FineReview()).upper_mm);
      EXPECT_LE(least_mm, 2.0 * FineReview().tolerance_mm) << "only what grazes may be left open";
    }
    EXPECT_TRUE(Touches(layout, frames, *study.curves[0].largest_touched_mm));
    EXPECT_FALSE(Touches(layout, frames, *study.curves[0].smallest_free_mm));
    for (double above_mm = 280.0; above_mm > *study.curves[0].smallest_free_mm; above_mm -= 20.0)
      EXPECT_FALSE(Touches(layout, frames, above_mm)) << above_mm;
  }
  EXPECT_GT(found, 1);
  EXPECT_LT(left_open, found);
}

// The box hull's top is at +50 mm, the base's at -80: a lid touches it up to 130 mm.
TEST(StudySpacing, OfABoxIsItsHeight) {
  const auto hull = std::make_shared<const recon::VisualHull>(BoxHull());
  const std::vector<StudyFrame> frames{{7, hull, {100.0, 5.0}}};
  const SpacingStudy study = StudySpacing(LidLayout(), Shared(frames), From(60.0, 200.0, 10.0, 0.0));
  ASSERT_TRUE(study.curves[0].largest_touched_mm && study.curves[0].smallest_free_mm);
  EXPECT_NEAR(*study.curves[0].largest_touched_mm, 130.0, 0.5 + kBoxHullMm);
  EXPECT_NEAR(*study.curves[0].smallest_free_mm, 130.0, 0.5 + kBoxHullMm);
  EXPECT_EQ(study.curves[0].steps.back().parts[kMoving].closest_frame, 7);
  const PartAtSpacing& at_200 = study.curves[0].steps.back().parts[kMoving];
  EXPECT_LE(at_200.lower_mm, 70.0 + kBoxHullMm);
  EXPECT_GE(at_200.upper_mm, 70.0 - kBoxHullMm);
  EXPECT_NEAR(study.curves[0].steps[0].parts[kFixed].upper_mm,
              study.curves[0].steps[5].parts[kFixed].upper_mm, 0.0);
}

TEST(StudySpacing, SaysWhenNothingOrEverythingTouches) {
  const auto hull = std::make_shared<const recon::VisualHull>(BoxHull());
  const std::vector<StudyFrame> frames{{0, hull, {100.0, 5.0}}};
  const SpacingStudy above = StudySpacing(LidLayout(), Shared(frames), From(140.0, 160.0, 10.0));
  EXPECT_FALSE(above.curves[0].largest_touched_mm.has_value());
  EXPECT_EQ(above.curves[0].smallest_free_mm, 140.0);
  const SpacingStudy within = StudySpacing(LidLayout(), Shared(frames), From(60.0, 100.0, 10.0));
  EXPECT_EQ(within.curves[0].largest_touched_mm, 100.0);
  EXPECT_FALSE(within.curves[0].smallest_free_mm.has_value());
  EXPECT_EQ(StudySpacing(LidLayout(), {}, From(60.0, 100.0, 10.0)).curves[0].smallest_free_mm, 60.0)
      << "no frames";
}

// Frames in two groups, and in two studies: the curves together are that of all frames.
TEST(StudySpacing, GroupsAndPiecesTogetherAreTheWhole) {
  recon::Random random(1283);
  std::vector<StudyFrame> frames = RandomFrames(&random, 12);
  SpacingStudyOptions options = From(0.0, 280.0, 20.0);
  const SpacingStudy whole = StudySpacing(LidLayout(), Shared(frames), options);
  options.groups = 2;
  for (std::size_t i = 0; i < frames.size(); ++i) frames[i].group = i % 3 == 0 ? 1 : 0;
  const SpacingStudy groups = StudySpacing(LidLayout(), Shared(frames), options);
  EXPECT_EQ(groups.curves[1].frames, 4);
  const SpacingCurve together = Together(groups.curves);
  EXPECT_EQ(together.frames, 12);
  std::vector<SpacingCurve> pieces;
  for (const auto& [from, to] : {std::pair{0, 5}, std::pair{5, 12}}) {
    const std::vector<StudyFrame> piece(frames.begin() + from, frames.begin() + to);
    const SpacingStudy study = StudySpacing(LidLayout(), Shared(piece), options);
    pieces.insert(pieces.end(), study.curves.begin(), study.curves.end());
  }
  const SpacingCurve of_pieces = Together(pieces);
  for (std::size_t step = 0; step < whole.curves[0].steps.size(); ++step)
    for (core::PartIndex part = 0; part < 4; ++part) {
      ExpectAgree(together.steps[step].parts[part], whole.curves[0].steps[step].parts[part]);
      ExpectAgree(of_pieces.steps[step].parts[part], whole.curves[0].steps[step].parts[part]);
    }
  // Each is found to the tolerance of its own bisection.
  for (const SpacingCurve* curve : {&together, &of_pieces}) {
    ASSERT_EQ(curve->smallest_free_mm.has_value(), whole.curves[0].smallest_free_mm.has_value());
    if (!curve->smallest_free_mm) continue;
    EXPECT_NEAR(*curve->smallest_free_mm, *whole.curves[0].smallest_free_mm, options.tolerance_mm);
  }
}

bool IsSame(const PartAtSpacing& a, const PartAtSpacing& b) {
  return a.frames_in_contact == b.frames_in_contact && a.frames_near == b.frames_near &&
         a.frames_undecided == b.frames_undecided && a.frames_clear == b.frames_clear &&
         a.deepest_mm == b.deepest_mm && a.lower_mm == b.lower_mm && a.upper_mm == b.upper_mm &&
         a.closest_frame == b.closest_frame;
}

// To the last bit, whatever else is asked.
void ExpectSame(const PartStudy& a, const PartStudy& b) {
  ASSERT_EQ(a.curves.size(), b.curves.size());
  for (std::size_t group = 0; group < a.curves.size(); ++group) {
    EXPECT_EQ(a.curves[group].frames, b.curves[group].frames);
    EXPECT_EQ(a.curves[group].largest_touched_mm, b.curves[group].largest_touched_mm);
    EXPECT_EQ(a.curves[group].smallest_free_mm, b.curves[group].smallest_free_mm);
    EXPECT_TRUE(std::ranges::equal(a.curves[group].steps, b.curves[group].steps, IsSame));
  }
  EXPECT_EQ(a.count.asked, b.count.asked);
  EXPECT_EQ(a.count.settled_by_motion, b.count.settled_by_motion);
  EXPECT_EQ(a.count.unmoved, b.count.unmoved);
  EXPECT_EQ(a.count.unchanged_frames, b.count.unchanged_frames);
}

TEST(StudyParts, AreThoseOfEachPartAlone) {
  core::Layout wide = LidLayout();
  wide.parts[kMoving] = BoxPart("lid", {90.0, 70.0, 12.0}, {0.0, 0.0, 0.0});
  const core::Layout narrow = LidLayout();
  // The other layout's spacings are the frame's in another order.
  core::Layout turned = narrow;
  std::swap(turned.spacings[0], turned.spacings[1]);
  for (int trial = 0; trial < 4 * test_support::SoakScale(); ++trial) {
    recon::Random random(trial);
    const std::vector<StudyFrame> frames = RandomFrames(&random, 12);
    const SpacingStudyOptions options = From(0.0, 200.0, 25.0);
    const std::vector<StudyLayout> layouts = {
        {&narrow, 0, {0, kMoving, kRider, kFixed}},
        {&wide, 0, {kMoving}},
        {&turned, 1, {kMoving, kFixed}, [](const std::vector<double>& mm) {
           return std::vector{mm[1], mm[0]};
         }}};
    const std::vector<PartStudy> together = StudyParts(layouts, Shared(frames), options);
    ASSERT_EQ(together.size(), 7U);
    std::size_t at = 0;
    for (const StudyLayout& layout : layouts) {
      for (const core::PartIndex part : layout.parts) {
        SCOPED_TRACE(at);
        StudyLayout alone = layout;
        alone.parts = {part};
        ExpectSame(together[at++], StudyParts({&alone, 1}, Shared(frames), options).front());
      }
    }
    ExpectSame(together[5], together[1]);
    ExpectSame(together[6], together[3]);
  }
}

TEST(CountOf, UnchangedFramesAreAllPartsOwn) {
  PartStudy a, b;
  a.count = {1, 2, 3, 4, 5};
  b.count = {10, 20, 30, 40, 5};
  const StudyCount sum = CountOf(std::vector{a, b});
  EXPECT_EQ(sum.asked, 11);
  EXPECT_EQ(sum.settled_by_motion, 22);
  EXPECT_EQ(sum.unmoved, 33);
  EXPECT_EQ(sum.queries, 44);
  EXPECT_EQ(sum.unchanged_frames, 5);
  EXPECT_EQ(CountOf(std::vector<PartStudy>{}).unchanged_frames, 0);
}

TEST(StudySpacing, AFrameThatStaysIsAskedOnce) {
  recon::Random random(77);
  const std::vector<StudyFrame> once = RandomFrames(&random, 3);
  std::vector<StudyFrame> twice;
  for (const StudyFrame& frame : once) twice.insert(twice.end(), 2, frame);
  const SpacingStudy a = StudySpacing(LidLayout(), Shared(once), From(0.0, 200.0, 25.0));
  const SpacingStudy b = StudySpacing(LidLayout(), Shared(twice), From(0.0, 200.0, 25.0));
  EXPECT_EQ(a.count.unchanged_frames, 0);
  EXPECT_EQ(b.count.unchanged_frames, 3);
  EXPECT_EQ(b.curves[0].frames, 6);
  for (std::size_t step = 0; step < a.curves[0].steps.size(); ++step)
    for (core::PartIndex i = 0; i < 4; ++i) {
      const PartAtSpacing &x = a.curves[0].steps[step].parts[i], &y = b.curves[0].steps[step].parts[i];
      EXPECT_EQ(2 * x.frames_in_contact, y.frames_in_contact);
      EXPECT_EQ(2 * x.frames_clear, y.frames_clear);
      EXPECT_EQ(x.deepest_mm, y.deepest_mm);
    }
}

TEST(SmallestClearMm, CountsDownFromTheLargestStep) {
  SpacingCurve curve;
  curve.frames = 2;
  for (const std::int64_t clear : {2, 1, 2, 2}) {
    PartAtSpacing part;
    part.frames_clear = clear;
    curve.steps.push_back({10.0 * static_cast<double>(curve.steps.size()), {part}});
  }
  EXPECT_EQ(SmallestClearMm(curve, std::vector<core::PartIndex>{0}), 20.0) << "not 0: 10 isn't clear";
  curve.steps.back().parts[0].frames_clear = 1;
  EXPECT_EQ(SmallestClearMm(curve, std::vector<core::PartIndex>{0}), std::nullopt);
}

TEST(StudySpacing, IsTheSameOnAnyNumberOfThreads) {
  recon::Random random(5);
  const std::vector<StudyFrame> frames = RandomFrames(&random, 20);
  const auto study = [&] { return StudySpacing(LidLayout(), Shared(frames), From(0.0, 200.0, 25.0)); };
  const SpacingStudy many = study();
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  const SpacingStudy one = study();
  EXPECT_EQ(one.count.queries, many.count.queries);
  EXPECT_EQ(one.curves[0].smallest_free_mm, many.curves[0].smallest_free_mm);
  for (std::size_t step = 0; step < one.curves[0].steps.size(); ++step) {
    for (std::size_t part = 0; part < 4; ++part) {
      EXPECT_EQ(one.curves[0].steps[step].parts[part].lower_mm,
                many.curves[0].steps[step].parts[part].lower_mm);
      EXPECT_EQ(one.curves[0].steps[step].parts[part].upper_mm,
                many.curves[0].steps[step].parts[part].upper_mm);
    }
  }
}

TEST(StudySpacing, ReportsProgressAndStops) {
  const auto hull = std::make_shared<const recon::VisualHull>(BoxHull());
  std::vector<StudyFrame> frames(40, {0, hull, {100.0, 5.0}});
  for (std::size_t i = 0; i < frames.size(); ++i) frames[i].spacing_mm[1] += static_cast<double>(i % 2);
  std::stop_source stop;
  std::int64_t reports = 0;
  const core::Progress progress([&](std::int64_t, std::int64_t total, const std::string&) {
    EXPECT_EQ(total, 40);
    if (++reports == 2) stop.request_stop();
  });
  try {
    (void)StudySpacing(LidLayout(), Shared(frames), From(60.0, 200.0, 70.0), progress, stop.get_token());
    FAIL() << "ran to its end";
  } catch (const core::Error& error) {
    EXPECT_EQ(error.kind(), core::ErrorKind::kCancelled);
  }
  EXPECT_EQ(reports, 2);
}

TEST(SpacingStudyOptions, StepsReachBothEnds) {
  EXPECT_EQ(From(10.0, 30.0, 10.0).Steps(), (std::vector{10.0, 20.0, 30.0}));
  EXPECT_EQ(From(10.0, 25.0, 10.0).Steps(), (std::vector{10.0, 20.0, 25.0}));
  EXPECT_EQ(From(10.0, 10.0, 1.0).Steps(), (std::vector{10.0}));
}

TEST(SpacingStudyOptions, RefusesWhatIsNoRange) {
  const core::Layout layout = LidLayout();
  for (const SpacingStudyOptions& options :
       {From(-1.0, 10.0, 1.0), From(0.0, 301.0, 1.0), From(20.0, 10.0, 1.0), From(0.0, 10.0, 0.0),
        From(0.0, 10.0, std::nan("")), From(0.0, 300.0, 1e-3), From(std::nan(""), 10.0, 1.0)})
    EXPECT_THROW(options.Validate(layout), core::Error);
}

}  // namespace
}  // namespace elbowroom::review
