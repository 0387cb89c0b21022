// What a what-if finds is what a replay finds: the replay is the oracle.
#include "app/control/reviewing/what_if.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <map>

#include "app/control/demo_parts.h"
#include "app/control/demo_trial.h"
#include "app/control/outcome_tracker.h"
#include "app/control/replay/replay.h"
#include "app/control/reviewing/needed_gap.h"
#include "app/control/reviewing/what_if_frames.h"
#include "core/error.h"
#include "core/gives_way.h"
#include "sessions/row_comparison.h"
#include "tests/app/reviewing/recorded_sessions.h"
#include "tests/sessions/sample_session.h"
#include "tests/support/temporary_folder.h"

namespace elbowroom::control {
namespace {

namespace fs = std::filesystem;
using test_support::TemporaryFolder;

// Frames by number, as they were judged.
struct Judged {
  WhatIf what_if;
  std::map<core::FrameIndex, core::FrameRecord> frames;
};

Judged JudgedAt(const ReviewedSession& session, const HeldGaps& held_mm) {
  Judged judged;
  const auto keep = [&](const FrameResult& result) { judged.frames[result.record.frame] = result.record; };
  judged.what_if = JudgeMotionAt(session, {held_mm, keep}, {}, {});
  return judged;
}

ReplayOutcome Replayed(const fs::path& recorded, const fs::path& replayed, const HeldGaps& held_mm) {
  return RunReplay(OpenWithOutcome(recorded, {}, {}), {replayed, {.held_mm = held_mm}, {}}, {}, {});
}

void ExpectSameOutcome(const core::SessionOutcome& what_if, const core::SessionOutcome& replay) {
  ASSERT_EQ(what_if.episodes.size(), replay.episodes.size());
  for (std::size_t i = 0; i < replay.episodes.size(); ++i) {
    tests::ExpectEqual(what_if.episodes[i], replay.episodes[i]);
    EXPECT_EQ(what_if.episodes[i].finding_id, replay.episodes[i].finding_id);
  }
  ASSERT_EQ(what_if.near_misses.size(), replay.near_misses.size());
  for (std::size_t i = 0; i < replay.near_misses.size(); ++i)
    tests::ExpectEqual(what_if.near_misses[i], replay.near_misses[i]);
}

void ExpectSameFigures(const WhatIf& what_if, const sessions::SessionReader& replay) {
  for (const sessions::PartTotals& totals : replay.part_totals()) {
    const WhatIfPart& part = what_if.parts.at(totals.part);
    double deepest_mm = 0.0;
    std::int64_t touches = 0;
    for (const core::ContactEpisode& touch : replay.episodes()) {
      if (touch.part != totals.part) continue;
      deepest_mm = std::max(deepest_mm, touch.peak_depth_mm);
      ++touches;
    }
    EXPECT_EQ(part.touches, touches);
    EXPECT_EQ(part.frames_in_contact, totals.frames_in_contact);
    EXPECT_EQ(part.deepest_mm, deepest_mm);
  }
}

// At each setting: rows frame by frame, touches, near misses, and which findings are gone.
void ExpectAsReplayed(const TemporaryFolder& folder, const std::vector<HeldGaps>& settings) {
  const ReviewedSession session(folder / "s.db", {}, {});
  for (const HeldGaps& held_mm : settings) {
    SCOPED_TRACE(held_mm.begin()->second);
    const fs::path file = folder / "replay.db";
    fs::remove(file);
    const ReplayOutcome replay = Replayed(folder / "s.db", file, held_mm);
    const Judged judged = JudgedAt(session, held_mm);
    const sessions::SessionReader reader(file);
    ASSERT_EQ(std::ssize(judged.frames), replay.frames);
    EXPECT_EQ(judged.what_if.frames, replay.frames);
    for (const auto& [frame, record] : judged.frames) {
      const core::FrameRecord replayed = reader.ReadFrame(frame);
      EXPECT_TRUE(sessions::CompareRows(replayed, record).are_equal) << frame;
      EXPECT_EQ(record.spacing_mm, replayed.spacing_mm);
    }
    ExpectSameOutcome(judged.what_if.outcome, replay.outcome);
    ExpectSameFigures(judged.what_if, reader);
    ASSERT_EQ(judged.what_if.vanished.size(), replay.absent.size());
    for (const core::Finding& absent : replay.absent)
      EXPECT_NE(std::ranges::find(judged.what_if.vanished, absent.id), judged.what_if.vanished.end());
  }
}

TEST(WhatIf, OfTheDemoIsAReplayAtThatGap) {
  const TemporaryFolder folder;
  RecordDemo(folder / "s.db", kWithTouches);
  ExpectAsReplayed(folder,
                   {{{kDemoGap, 140.0}}, {{kDemoGap, 160.0}}, {{kDemoGap, 195.5}}, {{kDemoGap, 240.0}}});
}

TEST(WhatIf, AmidOtherShapesWithStampsIsAReplayAtThatGap) {
  const TemporaryFolder folder;
  RecordOtherShapes(folder / "s.db");
  ASSERT_FALSE(sessions::SessionReader(folder / "s.db").episodes().empty());
  ExpectAsReplayed(folder, {{{"ball_gap", 60.0}},
                            {{"ball_gap", 120.0}},
                            {{"wall_gap", 20.0}},
                            {{"ball_gap", 40.0}, {"wall_gap", 150.0}}});
}

TEST(WhatIf, OfPartsThatGiveWayIsAReplayAtThatGap) {
  const TemporaryFolder folder;
  TrialSetup setup = MakeDemoTrial(DemoPlay::kOnce);
  setup.layout.parts[1].gives_way = core::PushRule{};
  RecordDemo(folder / "s.db", {60, 85}, setup);
  ExpectAsReplayed(folder, {{{kDemoGap, 150.0}}});
}

TEST(WhatIf, KeepsTheVerdictsOfPartsThatStay) {
  const TemporaryFolder folder;
  RecordOtherShapes(folder / "s.db");
  const ReviewedSession session(folder / "s.db", {}, {});
  const WhatIf ball = JudgeMotionAt(session, {{{"ball_gap", 130.0}}}, {}, {});
  EXPECT_EQ(ball.answers, 3 * ball.frames);
  EXPECT_GE(ball.answers_kept, 2 * ball.frames);
  EXPECT_LT(ball.answers_kept, ball.answers);
  EXPECT_FALSE(ball.parts[0].is_moved);
  EXPECT_TRUE(ball.parts[1].is_moved);
  EXPECT_FALSE(ball.parts[2].is_moved);
  EXPECT_EQ(ball.frames_without_camera, 1);
  // In the later frames the ball stood there in the trial, too.
  const WhatIf as_it_was = JudgeMotionAt(session, {{{"wall_gap", 60.0}}}, {}, {});
  EXPECT_EQ(as_it_was.answers_kept, as_it_was.answers);
  EXPECT_TRUE(as_it_was.vanished.empty());
  for (const WhatIfPart& part : as_it_was.parts) EXPECT_FALSE(part.is_moved);
}

TEST(WhatIf, CertifiesAClearanceOnlyWhereNothingTouches) {
  const TemporaryFolder folder;
  RecordDemo(folder / "s.db", kWithTouches);
  const ReviewedSession session(folder / "s.db", {}, {});
  const WhatIf narrow = JudgeMotionAt(session, {{{kDemoGap, 140.0}}}, {}, {});
  const WhatIf wide = JudgeMotionAt(session, {{{kDemoGap, 300.0}}}, {}, {});
  EXPECT_GT(narrow.parts[1].touches, 0);
  EXPECT_GT(narrow.DeepestMm(), 0.0);
  EXPECT_EQ(narrow.parts[1].clearance_mm, 0.0);
  EXPECT_EQ(narrow.parts[1].verdict(), core::Verdict::kContact);
  EXPECT_EQ(wide.parts[1].touches, 0);
  EXPECT_EQ(wide.parts[1].verdict(), core::Verdict::kClear);
  EXPECT_GE(*wide.parts[1].clearance_mm, session.header().trial.required_clearance_mm);
}

TEST(WhatIf, KnowsWhichTouchesAreNearMissesWithMoreSpace) {
  const TemporaryFolder folder;
  RecordDemo(folder / "s.db", kWithTouches);
  const ReviewedSession session(folder / "s.db", {}, {});
  const NeededGap needed = FindNeededGap(session, kDemoGap, {}, {});
  const WhatIf what_if = JudgeMotionAt(session, {{{kDemoGap, *needed.free_mm}}}, {}, {});
  EXPECT_EQ(what_if.parts[1].touches, 0);
  EXPECT_FALSE(what_if.eased.empty());
  const std::vector<core::Finding> findings = session.findings();
  for (const core::FindingId& id : what_if.eased) {
    EXPECT_EQ(std::ranges::find(findings, id, &core::Finding::id)->kind, core::FindingKind::kTouch);
    EXPECT_EQ(std::ranges::find(what_if.vanished, id), what_if.vanished.end());
  }
}

TEST(WhatIf, IsTheSameForOneThreadAndForMany) {
  const TemporaryFolder folder;
  RecordDemo(folder / "s.db", {60, 100});
  const ReviewedSession session(folder / "s.db", {}, {});
  const Judged many = JudgedAt(session, {{kDemoGap, 170.0}});
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const Judged single = JudgedAt(session, {{kDemoGap, 170.0}});
  ASSERT_EQ(many.frames.size(), single.frames.size());
  for (const auto& [frame, record] : many.frames)
    EXPECT_TRUE(sessions::CompareRows(record, single.frames.at(frame)).are_equal) << frame;
}

TEST(WhatIf, IsCancelledInTheMiddle) {
  const TemporaryFolder folder;
  RecordDemo(folder / "s.db", kWithTouches);
  const ReviewedSession session(folder / "s.db", {}, {});
  std::stop_source stop;
  std::int64_t last = 0;
  const core::Progress progress([&](std::int64_t done, std::int64_t, const std::string&) {
    last = done;
    stop.request_stop();
  });
  try {
    (void)JudgeMotionAt(session, {{{kDemoGap, 170.0}}}, progress, stop.get_token());
    FAIL();
  } catch (const core::Error& error) {
    EXPECT_EQ(error.kind(), core::ErrorKind::kCancelled);
  }
  EXPECT_LT(last, std::ssize(session.frames()));
}

TEST(WhatIf, RefusesAGapThatIsNotThere) {
  const TemporaryFolder folder;
  RecordDemo(folder / "s.db", {60, 64});
  const ReviewedSession session(folder / "s.db", {}, {});
  EXPECT_THROW((void)JudgeMotionAt(session, {{{"no_gap", 100.0}}}, {}, {}), core::Error);
  EXPECT_THROW((void)JudgeMotionAt(session, {{{kDemoGap, 4000.0}}}, {}, {}), core::Error);
}

// Asked for in any order, which is how a reviewer drags.
void ExpectFramesAsJudged(const fs::path& file, const HeldGaps& held_mm) {
  const auto session = std::make_shared<const ReviewedSession>(file, core::Progress(), std::stop_token());
  const Judged judged = JudgedAt(*session, held_mm);
  WhatIfFrames frames(session);
  const std::size_t count = session->frames().size();
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t position = (i * 17) % count;
    const SharedFrameResult frame = frames.At(position, held_mm);
    EXPECT_TRUE(sessions::CompareRows(judged.frames.at(frame->record.frame), frame->record).are_equal)
        << frame->record.frame;
    const SharedFrameResult recorded = frames.At(position, {});
    EXPECT_TRUE(sessions::CompareRows(session->ReadFrame(frame->record.frame), recorded->record).are_equal);
  }
}

TEST(WhatIfFrames, AreThoseOfTheWholeMotion) {
  const TemporaryFolder folder;
  RecordDemo(folder / "demo.db", {60, 90});
  ExpectFramesAsJudged(folder / "demo.db", {{kDemoGap, 165.0}});
  RecordOtherShapes(folder / "other.db");
  ExpectFramesAsJudged(folder / "other.db", {{"ball_gap", 70.0}});
}

}  // namespace
}  // namespace elbowroom::control
