// What is skipped from one setting to the next changes no verdict.
#include "app/control/pairs/pair_judge.h"

#include <gtest/gtest.h>

#include <random>

#include "app/control/pairs/ruled_pairs.h"
#include "tests/app/pairs/ruled_layouts.h"
#include "tests/support/soak.h"

namespace elbowroom::control {
namespace {

using review::testing::PartKind;

struct Kinds {
  const char* name;
  std::vector<PartKind> kinds;
};

std::vector<PartKind> Mixed(int parts) {
  std::vector<PartKind> kinds;
  for (int i = 0; i < parts; ++i) kinds.push_back(static_cast<PartKind>(i % review::testing::kPartKinds));
  return kinds;
}

const std::vector<Kinds>& AllKinds() {
  static const std::vector<Kinds> all = {
      {"flat", {PartKind::kPanel, PartKind::kBox, PartKind::kPanel, PartKind::kBox, PartKind::kPanel}},
      {"curved", std::vector<PartKind>(7, PartKind::kLumpyBall)},
      {"many", Mixed(21)}};
  return all;
}

TEST(PairJudge, OverAnyGapsHasTheVerdictsOfACheckerThatSkipsNothing) {
  std::mt19937_64 random(1);
  for (const Kinds& of : AllKinds()) {
    SCOPED_TRACE(of.name);
    review::ClashCount count;
    int broken = 0;
    for (int round = 0; round < 4 * test_support::SoakScale(); ++round) {
      const core::Layout layout = testing::StackOf(of.kinds, random);
      PairJudge judge(layout, RuledPairsOf(layout));
      std::vector<double> gaps_mm = layout.InitialSpacings();
      for (core::FrameIndex frame = 0; frame < 40; ++frame) {
        const SharedPairVerdicts verdicts = judge.Judge({frame, 0.1 * static_cast<double>(frame), gaps_mm});
        EXPECT_EQ(verdicts->setting.frame, frame);
        EXPECT_EQ(verdicts->setting.spacing_mm, gaps_mm);
        testing::ExpectSame(verdicts->pairs, testing::JudgedAnew(layout, gaps_mm).pairs);
        if (HasFailure()) return;
        count += verdicts->count;
        for (const review::PairClash& pair : verdicts->pairs) broken += IsBroken(pair) ? 1 : 0;
        gaps_mm = testing::NextGaps(layout, gaps_mm, random);
      }
    }
    EXPECT_GT(count.unchanged, 0);
    EXPECT_GT(count.moved_together, 0);
    EXPECT_GT(count.distance_calls, 0);
    EXPECT_GT(broken, 0);
    EXPECT_LT(broken, count.pairs);
    std::printf("%s: %ld pairs, %ld unchanged, %ld moved together, %ld by bounds; broken %d times\n", of.name,
                static_cast<long>(count.pairs), static_cast<long>(count.unchanged),
                static_cast<long>(count.moved_together), static_cast<long>(count.settled_by_bounds), broken);
  }
}

TEST(PairJudge, APairThatOnlyMovedTogetherIsNotAskedAgainWhereverItGoes) {
  core::Layout layout = testing::ThreeBoxes();
  layout.groups = {{"raised", {"upper", "aside"}}};
  layout.parts[1].world_from_part.translation_mm = {0.0, 0.0, 60.0};
  layout.parts[2].world_from_part.translation_mm = {55.0, 0.0, 60.0};
  layout.spacings[0].moving = "raised";
  layout.pair_rules = {{"upper", "aside", 10.0, false}};
  PairJudge judge(layout, RuledPairsOf(layout));
  EXPECT_EQ(judge.Judge({0, 0.0, {30.0}})->count.distance_calls, 1);
  for (int i = 1; i <= 1000; ++i) {
    const double gap_mm = 30.0 + i / 7.0;
    const SharedPairVerdicts verdicts = judge.Judge({i, 0.0, {gap_mm}});
    ASSERT_EQ(verdicts->count.moved_together, 1);
    ASSERT_EQ(verdicts->count.distance_calls, 0);
    const review::PairClash& pair = verdicts->pairs.front();
    ASSERT_EQ(pair.verdict, core::Verdict::kNear);
    ASSERT_NEAR(pair.gap->distance_mm, 5.0, 1e-9);
    ASSERT_GE(pair.gap->on_a.z(), 50.0 + gap_mm - 1e-9) << "the points move with the parts";
    ASSERT_LE(pair.gap->on_a.z(), 100.0 + gap_mm + 1e-9);
  }
}

TEST(RuledPairs, AreThoseOfRulesAndASpacingMovesThoseOfItsParts) {
  core::Layout layout = testing::ThreeBoxes();
  const std::vector<review::PairDemand> pairs = RuledPairsOf(layout);
  ASSERT_EQ(pairs.size(), 2U);
  EXPECT_EQ(pairs[0].required_mm, 20.0);
  EXPECT_EQ(pairs[1].required_mm, 2.0);
  EXPECT_EQ(PairsMovedBy(layout, 0, pairs), std::vector<std::size_t>({0}));
  layout.pair_rules[0].ignore = true;
  EXPECT_EQ(RuledPairsOf(layout).size(), 1U);
}

}  // namespace
}  // namespace elbowroom::control
