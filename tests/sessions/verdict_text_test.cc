#include "sessions/report/verdict_text.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "sessions/report/chart.h"
#include "sessions/report/report_document.h"
#include "tests/sessions/sample_session.h"
#include "tests/sessions/sample_trial.h"
#include "tests/support/temporary_folder.h"

namespace elbowroom::tests {
namespace {

using namespace std::string_literals;
using test_support::TemporaryFolder;

sessions::ReportData DataOf(const TrialPlan& plan) {
  const TemporaryFolder folder;
  WriteTrial(folder / "s.db", plan);
  return sessions::CollectReportData(sessions::SessionReader(folder / "s.db"));
}
std::string VerdictOf(const TrialPlan& plan) { return sessions::VerdictSentence(DataOf(plan)); }

TEST(VerdictText, TouchedBelowAndFreeAbove) {
  EXPECT_EQ(VerdictOf(UsualTrial()),
            "7 touches in 62.0 s, all with 'PMT to payload A' at 140 mm; the task needed more than 140 mm "
            "and at most "
            "240 mm, up to 100 mm more than the participant's estimate of 140 mm.");
  EXPECT_EQ(sessions::TouchesByPart(DataOf(UsualTrial())),
            "2 on PMT box, 5 on payload A, none on payload B.");
  EXPECT_EQ(sessions::SpaceNeeded(DataOf(UsualTrial())), "140\u2013240 mm");
}

TEST(VerdictText, AnEstimateBetweenTouchedAndFreeWasNotTried) {
  TrialPlan plan = UsualTrial();
  plan.estimate_mm = 200.0;
  EXPECT_TRUE(VerdictOf(plan).ends_with(
      "at most 240 mm; the participant's estimate of 200 mm lies above what was touched "
      "and was not tried."))
      << VerdictOf(plan);
  plan.estimate_mm = 250.0;
  EXPECT_TRUE(VerdictOf(plan).ends_with("; the participant's estimate of 250 mm is enough."))
      << VerdictOf(plan);
  plan.estimate_mm = 0.0;
  EXPECT_TRUE(VerdictOf(plan).ends_with("at most 240 mm.")) << VerdictOf(plan);
}

TEST(VerdictText, ShortfallIsTheSpaceNeededLessTheEstimate) {
  TrialPlan plan = UsualTrial();  // touched at 140 mm, free of touches at 240 mm
  const auto shortfall = [&](double estimate_mm) {
    plan.estimate_mm = estimate_mm;
    return sessions::Shortfall(DataOf(plan));
  };
  EXPECT_EQ(shortfall(100.0), "40\u2013140 mm");
  EXPECT_EQ(shortfall(140.0), "0\u2013100 mm");
  EXPECT_EQ(shortfall(200.0), "at most 40 mm");
  EXPECT_EQ(shortfall(240.0), "none");
  EXPECT_EQ(shortfall(0.0), "unknown");
  plan.opened_at_s = 100.0;  // never
  EXPECT_EQ(shortfall(100.0), "more than 40 mm");
  EXPECT_EQ(shortfall(200.0), "unknown");
  plan = UsualTrial();
  plan.is_finished = false;  // the rest of the task might have touched at 240 mm
  EXPECT_EQ(shortfall(100.0), "more than 40 mm");
}

TEST(VerdictText, SpaceProvidedIsWhatTheSpacingWas) {
  TrialPlan plan = UsualTrial();
  EXPECT_EQ(sessions::SpaceProvided(DataOf(plan)), "140\u2013240 mm");
  plan.opened_at_s = 100.0;
  EXPECT_EQ(sessions::SpaceProvided(DataOf(plan)), "140 mm");
}

TEST(VerdictText, TilesBeginWithTheDecision) {
  const sessions::Tiles tiles = sessions::TilesOf(DataOf(UsualTrial()));
  ASSERT_GE(tiles.tiles.size(), 5U);
  EXPECT_EQ(tiles.tiles[0].title, "Space provided");
  EXPECT_EQ(tiles.tiles[1].title, "Space needed");
  EXPECT_EQ(tiles.tiles[1].value, "140\u2013240 mm");
  EXPECT_EQ(tiles.tiles[1].remark, "without a tool 140\u2013240 mm, with tongs 140\u2013240 mm");
  EXPECT_EQ(tiles.tiles[3].title, "Shortfall");
  EXPECT_EQ(tiles.tiles[3].value, "0\u2013100 mm");
  const auto sure = std::ranges::find(tiles.tiles, "How sure", &sessions::Tile::title);
  ASSERT_NE(sure, tiles.tiles.end());
  EXPECT_TRUE(sure->remark.ends_with("the gauge passed")) << sure->remark;
}

TEST(VerdictText, TouchedAtEverySpacingTried) {
  TrialPlan plan = UsualTrial();
  plan.opened_at_s = 100.0;
  EXPECT_TRUE(
      VerdictOf(plan).ends_with("; the task needed more than 140 mm, and no larger spacing was held free of "
                                "touches, more than the participant's estimate of 140 mm."))
      << VerdictOf(plan);
}

TEST(VerdictText, ASpacingThatWasOnlyPassedProvesNothing) {
  TrialPlan plan = UsualTrial();
  plan.duration_s = plan.opened_at_s + sessions::kTriedFor_s - 0.5;
  EXPECT_FALSE(DataOf(plan).spacings[0].smallest_free_mm.has_value());
  plan.duration_s = plan.opened_at_s + sessions::kTriedFor_s + 0.5;
  EXPECT_EQ(DataOf(plan).spacings[0].smallest_free_mm, 240.0);
}

TEST(VerdictText, ATouchAtALargerSpacingOverrulesASmallerFreeOne) {
  TrialPlan plan = UsualTrial();
  plan.touches = {{1, 40.0, 41.0, 3.0}};
  const sessions::ReportData data = DataOf(plan);
  EXPECT_EQ(data.spacings[0].largest_touched_mm, 240.0);
  EXPECT_FALSE(data.spacings[0].smallest_free_mm.has_value());
  EXPECT_TRUE(VerdictOf(plan).starts_with("1 touch in 62.0 s, all with 'PMT to payload A' at 240 mm; "))
      << VerdictOf(plan);
}

TEST(VerdictText, NothingTouched) {
  TrialPlan plan = UsualTrial();
  plan.touches.clear();
  EXPECT_EQ(VerdictOf(plan),
            "Nothing was touched in 62.0 s; 140 mm was enough, the smallest spacing tried; the participant's "
            "estimate of "
            "140 mm is enough.");
}

// That nothing was touched up to there says nothing of the rest of the task.
TEST(VerdictText, ASessionThatWasCutOffConcludesOnlyFromItsTouches) {
  TrialPlan plan = UsualTrial();
  sessions::ReportData data = DataOf(plan);
  data.status = sessions::SessionStatus::kCutOff;
  EXPECT_TRUE(
      sessions::VerdictSentence(data).starts_with("The recording broke off after 62.0 s with 7 touches"))
      << sessions::VerdictSentence(data);
  EXPECT_TRUE(sessions::VerdictSentence(data).ends_with("; the task needs more than 140 mm."))
      << sessions::VerdictSentence(data);
  EXPECT_EQ(sessions::SpaceNeeded(data), "more than 140 mm");
  plan.touches.clear();
  data = DataOf(plan);
  data.status = sessions::SessionStatus::kCutOff;
  EXPECT_EQ(
      sessions::VerdictSentence(data),
      "The recording broke off after 62.0 s with nothing touched; what space the whole task needs isn't "
      "known.");
  EXPECT_EQ(sessions::SpaceNeeded(data), "unknown");
}

TEST(VerdictText, SeveralTouchedSpacingsAreListed) {
  TrialPlan plan = UsualTrial();
  plan.touches = {{1, 3.0, 4.0, 3.0}, {1, 34.7, 34.8, 2.0}};  // the second while passing 180 and 200 mm
  EXPECT_TRUE(
      VerdictOf(plan).starts_with("2 touches in 62.0 s, with 'PMT to payload A' at 140, 180 and 200 mm;"))
      << VerdictOf(plan);
}

TEST(ReportData, TimesAndFramesAddUp) {
  const sessions::ReportData data = DataOf(UsualTrial());
  constexpr double kRounding_s = 1e-9;  // sums of a few hundred doubles
  double held_s = 0.0;
  std::int64_t frames = 0, touches = 0, frames_in_contact = 0;
  for (const sessions::SpacingLevel& level : data.spacings[0].levels) {
    held_s += level.held_s;
    frames += level.frames;
    touches += level.touches;
    frames_in_contact += level.frames_in_contact;
  }
  EXPECT_NEAR(held_s, data.end_s - data.begin_s, kRounding_s);
  EXPECT_EQ(frames, 620);
  EXPECT_EQ(touches, 7);
  EXPECT_EQ(frames_in_contact, data.frames_in_contact);
  EXPECT_NEAR(data.in_contact_s, 0.1 * static_cast<double>(frames_in_contact), 1e-6);
  EXPECT_EQ(data.spacings[0].steps.size(), 6U);
}

TEST(Chart, TicksAreRoundAndFew) {
  for (const auto& [low, high] :
       {std::pair(0.0, 62.0), {0.0, 0.3}, {139.0, 241.5}, {-10.0, 50.0}, {5.0, 14.2e6}}) {
    const std::vector<double> ticks = sessions::RoundTicks(low, high, 12);
    EXPECT_GE(ticks.size(), 3U) << low << " to " << high;
    EXPECT_LE(ticks.size(), 12U) << low << " to " << high;
    EXPECT_GE(ticks.front(), low - 1e-9);
    EXPECT_LE(ticks.back(), high + 1e-9);
  }
  EXPECT_EQ(sessions::RoundTicks(0.0, 62.0, 12), (std::vector<double>{0, 10, 20, 30, 40, 50, 60}));
}

TEST(Chart, DepthColoursDarken) {
  EXPECT_EQ(sessions::DepthColour(0.0), "#fdd49e");
  EXPECT_EQ(sessions::DepthColour(1.0), "#730000");
  EXPECT_EQ(sessions::DepthColour(7.0), "#730000");
}

TEST(Chart, NamesAreCutBetweenCharacters) {
  EXPECT_EQ(sessions::Shortened("short", 8), "short");
  EXPECT_EQ(sessions::Shortened("12345\u00e978", 6), "12345\u2026"s);
}

}  // namespace
}  // namespace elbowroom::tests
