// Two virtual parts over the time of a trial.
#include "sessions/report/pair_course.h"

#include <gtest/gtest.h>

#include "tests/sessions/sample_session.h"

namespace elbowroom::tests {
namespace {

using core::Verdict;
using sessions::PairApproaches;
using sessions::PairCourse;
using sessions::PairDistance;
using sessions::ReportData;

constexpr double kPeriod_s = 0.1;

// A frame each kPeriod_s at these values of one spacing.
ReportData DataAt(const std::vector<double>& gaps_mm) {
  ReportData data;
  data.header = SampleHeader();
  for (const double gap_mm : gaps_mm) {
    const auto i = static_cast<core::FrameIndex>(data.frames.size());
    data.frames.push_back({i, kPeriod_s * static_cast<double>(i), {gap_mm}});
  }
  data.frame_period_s = kPeriod_s;
  data.columns = {0.0, kPeriod_s * static_cast<double>(gaps_mm.size()), gaps_mm.size()};
  return data;
}

// One pair, 20 mm apart by its rule, at 12, 30 and 40 mm; at 30 mm and 40 mm bounds were enough.
PairApproaches OnePair() {
  PairApproaches approaches;
  approaches.pairs = {{0, 1, 20.0, false}};
  approaches.judged = {{{12.0}, {{Verdict::kNear, 12.0, 11.0}}},
                       {{30.0}, {{Verdict::kClear, std::nullopt, 28.0}}},
                       {{40.0}, {{Verdict::kClear, std::nullopt, 38.0}}}};
  approaches.settings = 4;
  return approaches;
}

TEST(PairCourse, HasTheClosestSettingAndHowLongTheRuleWasBroken) {
  const ReportData data = DataAt({30, 35, 12, 12, 12, 30, 40});  // 35 mm wasn't judged
  const PairApproaches approaches = OnePair();
  const std::vector<PairCourse> courses = sessions::CoursesOf(data, approaches);
  ASSERT_EQ(courses.size(), 1U);
  EXPECT_EQ(courses[0].closest, approaches.Find({12.0}));
  EXPECT_DOUBLE_EQ(courses[0].time_s, 0.2);
  EXPECT_NEAR(courses[0].broken_s, 0.3, 1e-9);
  ASSERT_EQ(courses[0].columns.size(), 7U);
  EXPECT_EQ(courses[0].columns[0]->at_least_mm, 28.0);
  EXPECT_FALSE(courses[0].columns[1].has_value());
  EXPECT_EQ(courses[0].columns[4]->gap_mm, 12.0);
  EXPECT_EQ(courses[0].columns[6]->at_least_mm, 38.0);
}

TEST(PairCourse, AFrameCountsUntilTheNext) {
  ReportData data = DataAt({12, 30, 30});
  data.frames[1].time_s = data.frames[2].time_s = 0.25;
  EXPECT_NEAR(sessions::CoursesOf(data, OnePair()).at(0).broken_s, 0.25, 1e-9);
}

TEST(PairCourse, ContactThatIsAllowedBreaksNoRule) {
  PairApproaches approaches = OnePair();
  approaches.judged = {{{0.0}, {{Verdict::kContact, 0.0, 0.0}}}};
  const ReportData data = DataAt({0, 0});
  EXPECT_NEAR(sessions::CoursesOf(data, approaches).at(0).broken_s, 0.2, 1e-9);
  approaches.pairs[0].authorised_contact = true;
  EXPECT_EQ(sessions::CoursesOf(data, approaches).at(0).broken_s, 0.0);
  approaches.judged[0].distances[0].verdict = Verdict::kUndecided;
  EXPECT_NEAR(sessions::CoursesOf(data, approaches).at(0).broken_s, 0.2, 1e-9);
}

TEST(PairCourse, NeedsAFrameThatWasJudged) {
  EXPECT_TRUE(sessions::CoursesOf(DataAt({99, 98}), OnePair()).empty());
  EXPECT_TRUE(sessions::CoursesOf(DataAt({12}), {}).empty());
}

TEST(PairChart, ShowsThePairsNearestToBreakingTheirRules) {
  const ReportData data = DataAt({30, 12});
  PairApproaches approaches;
  for (std::size_t i = 0; i < sessions::kMostPairPanels + 2; ++i)
    approaches.pairs.push_back({0, 1, 5.0, false});
  approaches.judged = {{{12.0}, {}}, {{30.0}, {}}};
  for (sessions::PairSetting& setting : approaches.judged) {
    for (std::size_t i = 0; i < approaches.pairs.size(); ++i)
      setting.distances.push_back(
          {Verdict::kClear, setting.spacing_mm[0] + 10.0 * static_cast<double>(i), 5.0});
  }
  approaches.pairs[0].required_mm = -100.0;  // the closest, and the farthest from its rule
  const sessions::Chart chart = sessions::PairChart(data, approaches, sessions::CoursesOf(data, approaches));
  ASSERT_EQ(chart.panels.size(), sessions::kMostPairPanels);
  ASSERT_EQ(chart.panels[0].lines.size(), 1U);
  EXPECT_EQ(chart.panels[0].lines[0].name, "gap");
  EXPECT_EQ(chart.panels[0].lines[0].points.front().y, 40.0) << "the second pair";
  EXPECT_EQ(chart.panels[0].lines[0].points.back().y, 22.0);
}

TEST(PairChart, DashesWhereOnlyABoundIsKnown) {
  const ReportData data = DataAt({30, 12, 35});
  const PairApproaches approaches = OnePair();
  const sessions::Chart chart = sessions::PairChart(data, approaches, sessions::CoursesOf(data, approaches));
  ASSERT_EQ(chart.panels.size(), 1U);
  const std::vector<sessions::ChartLine>& lines = chart.panels[0].lines;
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_FALSE(lines[0].is_dashed);
  EXPECT_TRUE(lines[1].is_dashed);
  ASSERT_EQ(lines[0].points.size(), 6U);
  EXPECT_FALSE(lines[0].points[0].y.has_value());
  EXPECT_EQ(lines[0].points[2].y, 12.0);
  EXPECT_EQ(lines[1].points[0].y, 28.0);
  EXPECT_FALSE(lines[1].points[2].y.has_value());
  EXPECT_FALSE(lines[1].points[4].y.has_value()) << "35 mm wasn't judged";
  ASSERT_EQ(chart.panels[0].levels.size(), 1U);
  EXPECT_EQ(chart.panels[0].levels[0].y, 20.0);
}

}  // namespace
}  // namespace elbowroom::tests
