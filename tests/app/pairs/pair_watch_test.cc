#include "app/control/pairs/pair_watch.h"

#include <gtest/gtest.h>

#include <random>

#include "core/error.h"
#include "tests/app/pairs/ruled_layouts.h"

namespace elbowroom::control {
namespace {

using review::testing::PartKind;

TEST(PairWatch, HasTheVerdictsOfTheSettingWhenItIsWaitedFor) {
  std::mt19937_64 random(5);
  const core::Layout layout = testing::StackOf(std::vector<PartKind>(7, PartKind::kPrism), random);
  PairWatch watch(layout);
  std::vector<double> gaps_mm = layout.InitialSpacings();
  for (core::FrameIndex frame = 0; frame < 30; ++frame) {
    const std::vector<double> last_mm = gaps_mm;
    if (frame % 2 == 0) gaps_mm = testing::NextGaps(layout, gaps_mm, random);
    watch.Ask(frame, 0.0, gaps_mm);
    const std::vector<SharedPairVerdicts> verdicts = watch.Take(std::nullopt);
    if (frame > 0 && gaps_mm == last_mm) {
      EXPECT_TRUE(verdicts.empty()) << "it was judged already";
      continue;
    }
    ASSERT_EQ(verdicts.size(), 1U);
    EXPECT_EQ(verdicts[0]->setting.frame, frame);
    testing::ExpectSame(verdicts[0]->pairs, testing::JudgedAnew(layout, gaps_mm).pairs);
  }
}

TEST(PairWatch, IsNeverMoreThanOneSettingBehindAndEndsWithTheLast) {
  std::mt19937_64 random(6);
  const core::Layout layout = testing::StackOf(std::vector<PartKind>(21, PartKind::kLumpyBall), random);
  PairWatch watch(layout);
  std::vector<SharedPairVerdicts> all;
  const auto take = [&](std::optional<std::chrono::milliseconds> patience) {
    for (const SharedPairVerdicts& verdicts : watch.Take(patience)) all.push_back(verdicts);
  };
  std::vector<double> gaps_mm = layout.InitialSpacings();
  constexpr core::FrameIndex kAsked = 300;
  for (core::FrameIndex frame = 0; frame < kAsked; ++frame) {
    gaps_mm[0] = 0.1 * static_cast<double>(frame);
    watch.Ask(frame, 0.0, gaps_mm);
    take(std::chrono::milliseconds(0));
  }
  take(std::nullopt);
  ASSERT_FALSE(all.empty());
  EXPECT_EQ(all.back()->setting.frame, kAsked - 1);
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (i > 0) {
      EXPECT_LT(all[i - 1]->setting.frame, all[i]->setting.frame);
    }
    testing::ExpectSame(all[i]->pairs, testing::JudgedAnew(layout, all[i]->setting.spacing_mm).pairs);
  }
  take(std::nullopt);
  EXPECT_EQ(all.back()->setting.frame, kAsked - 1) << "nothing more comes";
}

TEST(PairWatch, WithoutRulesHasNothingToSay) {
  core::Layout layout = testing::ThreeBoxes();
  layout.pair_rules.clear();
  PairWatch watch(layout);
  watch.Ask(0, 0.0, layout.InitialSpacings());
  EXPECT_TRUE(watch.Take(std::nullopt).empty());
  EXPECT_TRUE(watch.pairs().empty());
}

TEST(PairWatch, EndsWhileItJudges) {
  std::mt19937_64 random(7);
  const core::Layout layout = testing::StackOf(std::vector<PartKind>(21, PartKind::kLumpyBall), random);
  for (int i = 0; i < 5; ++i) {
    PairWatch watch(layout);
    watch.Ask(0, 0.0, layout.InitialSpacings());
  }
}

TEST(PairWatch, PassesOnWhatTheJudgingThrows) {
  core::Layout layout = testing::ThreeBoxes();
  layout.parts[1].mesh = std::make_shared<const core::TriangleMesh>();
  PairWatch watch(layout);
  watch.Ask(0, 0.0, layout.InitialSpacings());
  EXPECT_ANY_THROW((void)watch.Take(std::nullopt));
}

}  // namespace
}  // namespace elbowroom::control
