#include "app/control/reviewing/session_timeline.h"

#include <gtest/gtest.h>

#include "app/control/demo_trial.h"
#include "tests/app/reviewing/recorded_sessions.h"
#include "tests/support/temporary_folder.h"

namespace elbowroom::control {
namespace {

using test_support::TemporaryFolder;

TEST(SessionTimeline, HasEveryTouchInTheRowOfItsPart) {
  const TemporaryFolder folder;
  RecordDemo(folder / "s.db", {20, 300});
  const ReviewedSession session(folder / "s.db", {}, {});
  const std::vector<ListedFinding> findings = ListFindings(session);
  const SessionTimeline timeline = TimelineOf(session, findings);
  EXPECT_EQ(timeline.begin_s, session.frames().front().time_s);
  EXPECT_EQ(timeline.end_s, session.frames().back().time_s);
  ASSERT_EQ(timeline.rows.size(), session.header().layout.parts.size());
  std::size_t spans = 0;
  for (const TimelineRow& row : timeline.rows) {
    for (const TimelineSpan& span : row.spans) {
      const core::Finding& finding = findings.at(span.finding).finding;
      EXPECT_EQ(finding.part, row.part);
      EXPECT_EQ(finding.begin_s, span.begin_s);
      EXPECT_EQ(finding.end_s, span.end_s);
      ++spans;
    }
  }
  EXPECT_EQ(spans, findings.size());
  EXPECT_GE(spans, 2U);
}

TEST(SessionTimeline, SaysWhatHappenedAndTakesADraggedSliderForOneMark) {
  const TemporaryFolder folder;
  TrialSetup setup = MakeDemoTrial(DemoPlay::kOnce);
  setup.script = {{60, SpacingRequest{"payload_a_gap", 150.0}},
                  {61, SpacingRequest{"payload_a_gap", 160.0}},
                  {62, SpacingRequest{"payload_a_gap", 170.0}},
                  {65, ToolRequest{"tongs", true}},
                  {95, SpacingRequest{"payload_a_gap", 200.0}}};
  RecordDemo(folder / "s.db", {55, 100}, setup);
  const ReviewedSession session(folder / "s.db", {}, {});
  const SessionTimeline timeline = TimelineOf(session, ListFindings(session));
  std::vector<std::string> gaps, tools;
  for (const TimelineMark& mark : timeline.marks) {
    if (mark.kind == MarkKind::kGap) gaps.push_back(mark.text);
    if (mark.kind == MarkKind::kTool) tools.push_back(mark.text);
  }
  EXPECT_EQ(gaps, (std::vector<std::string>{"payload_a_gap from 140 to 170 mm",
                                            "payload_a_gap from 170 to 200 mm"}));
  EXPECT_EQ(tools, std::vector<std::string>{"tongs taken in use"});
}

TEST(SessionTimeline, HasARowAPartOfWhatAWhatIfFound) {
  core::Layout layout;
  layout.parts.resize(2);
  layout.parts[1].name = "box";
  core::SessionOutcome outcome;
  outcome.episodes.resize(1);
  outcome.episodes[0].part = 1;
  outcome.episodes[0].begin_time_s = 2.0;
  outcome.episodes[0].end_time_s = 3.0;
  outcome.near_misses.resize(1);
  outcome.near_misses[0].begin_time_s = 4.0;
  const std::vector<TimelineRow> rows = RowsOf(layout, outcome);
  ASSERT_EQ(rows.size(), 2U);
  ASSERT_EQ(rows[1].spans.size(), 1U);
  EXPECT_EQ(rows[1].part, "box");
  EXPECT_EQ(rows[1].spans[0].begin_s, 2.0);
  EXPECT_EQ(rows[1].spans[0].end_s, 3.0);
  ASSERT_EQ(rows[0].spans.size(), 1U);
  EXPECT_EQ(rows[0].spans[0].kind, core::FindingKind::kNearMiss);
}

TEST(SessionTimeline, StepsFromTouchToTouch) {
  std::vector<ListedFinding> findings(4);
  findings[0].worst_position = 30;
  findings[1].worst_position = 10;
  findings[3].worst_position = 50;
  EXPECT_EQ(NextFinding(findings, 0, 1), 1U);
  EXPECT_EQ(NextFinding(findings, 10, 1), 0U);
  EXPECT_EQ(NextFinding(findings, 30, 1), 3U);
  EXPECT_EQ(NextFinding(findings, 50, 1), std::nullopt);
  EXPECT_EQ(NextFinding(findings, 30, -1), 1U);
  EXPECT_EQ(NextFinding(findings, 10, -1), std::nullopt);
}

}  // namespace
}  // namespace elbowroom::control
