#include <gtest/gtest.h>

#include <random>
#include <set>

#include "core/procedure/answers.h"
#include "core/procedure/event_text.h"
#include "core/procedure/step_runs.h"

namespace elbowroom::core {
namespace {

SessionEvent Mark(FrameIndex frame, const std::string& step, bool begun) {
  return {frame, static_cast<double>(frame) / 30.0, StepMarked{step, begun}};
}

TEST(StepRuns, AStepThatIsBegunAgainHasAnotherRun) {
  const std::vector<StepRun> runs =
      StepRunsOf(std::vector{Mark(0, "reach", true), Mark(3, "reach", false), Mark(3, "screw", true),
                             Mark(6, "screw", false), Mark(6, "reach", true)});
  ASSERT_EQ(runs.size(), 3U);
  EXPECT_EQ(runs[0], (StepRun{"reach", 0, 0.0, 3, 0.1}));
  EXPECT_EQ(runs[1], (StepRun{"screw", 3, 0.1, 6, 0.2}));
  EXPECT_EQ(runs[2].step, "reach");
  EXPECT_FALSE(runs[2].duration_s());
  EXPECT_DOUBLE_EQ(*runs[1].duration_s(), 0.1);
}

// Slow and obviously right: in how many frames each step is under way, asked frame by frame.
TEST(StepRuns, HoldTheFramesInWhichEachStepIsUnderWay) {
  std::mt19937 random(7);
  for (int trial = 0; trial < 200; ++trial) {
    std::vector<SessionEvent> events;
    FrameIndex frame = 0;
    for (int i = 0; i < 12; ++i) {
      frame += static_cast<FrameIndex>(random() % 3);
      events.push_back(Mark(frame, std::string(1, static_cast<char>('a' + random() % 3)), random() % 2 == 0));
    }
    const std::vector<StepRun> runs = StepRunsOf(events);
    for (FrameIndex at = 0; at <= frame; ++at) {
      std::multiset<std::string> under_way, expected;
      for (const StepRun& run : runs)
        if (run.begin_frame <= at && at < run.end_frame.value_or(frame + 1)) under_way.insert(run.step);
      for (const std::string step : {"a", "b", "c"}) {
        bool is_under_way = false;
        for (const SessionEvent& event : events) {
          const auto& mark = std::get<StepMarked>(event.what);
          if (event.frame <= at && mark.step == step) is_under_way = mark.begun;
        }
        if (is_under_way) expected.insert(step);
      }
      EXPECT_EQ(under_way, expected);
    }
  }
}

TEST(Answers, TheLastOneHolds) {
  TrialInfo trial;
  trial.survey = {{AskedWhen::kBefore, "effort", 1, 7}, {AskedWhen::kAfter, "effort", 1, 7}};
  trial.estimate_mm = 140.0;
  const std::vector<SessionEvent> events = {{0, 0.0, SurveyAnswered{AskedWhen::kBefore, "effort", 2}},
                                            {9, 0.3, SurveyAnswered{AskedWhen::kBefore, "effort", 3}},
                                            {9, 0.3, SurveyAnswered{AskedWhen::kAfter, "another", 3}},
                                            {9, 0.3, EstimateGiven{AskedWhen::kAfter, 200.0}}};
  EXPECT_EQ(AnswersOf(trial, events), (std::vector<std::optional<int>>{3, std::nullopt}));
  EXPECT_EQ(EstimatesOf(trial, events).before_mm, 140.0);
  EXPECT_EQ(EstimatesOf(trial, events).after_mm, 200.0);
  EXPECT_FALSE(EstimatesOf({}, {}).before_mm);
}

TEST(EventText, EachKindHasItsWords) {
  const auto words = [](const EventContent& what) {
    return std::pair(std::string(KindOf(what)), EventText(what));
  };
  using Pair = std::pair<std::string, std::string>;
  EXPECT_EQ(words(SpacingChanged{"gap", 140.0, 152.5}), Pair("spacing", "gap from 140 to 152.5 mm"));
  EXPECT_EQ(words(ToolMarked{"tongs", true}), Pair("tool", "tongs taken in use"));
  EXPECT_EQ(words(Note{"hm"}), Pair("note", "hm"));
  EXPECT_EQ(words(StepMarked{"reach", false}), Pair("step", "step 'reach' ended"));
  EXPECT_EQ(words(Bookmark{}), Pair("bookmark", "bookmark"));
  EXPECT_EQ(words(Bookmark{"dropped"}), Pair("bookmark", "bookmark: dropped"));
  EXPECT_EQ(words(EstimateGiven{AskedWhen::kAfter, 240.0}),
            Pair("estimate", "estimate after the trial: 240 mm"));
  EXPECT_EQ(words(SurveyAnswered{AskedWhen::kBefore, "effort", 5}),
            Pair("answer", "before the trial, 'effort': 5"));
}

}  // namespace
}  // namespace elbowroom::core
