#include "app/control/replay/replay.h"

#include <SQLiteCpp/SQLiteCpp.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <string>
#include <vector>

#include "app/control/demo_trial.h"
#include "app/control/outcome_tracker.h"
#include "app/control/trial_runner.h"
#include "core/error.h"
#include "core/gives_way.h"
#include "core/procedure/step_runs.h"
#include "sessions/after_trial.h"
#include "sessions/session_reader.h"
#include "tests/app/replay/session_rows.h"
#include "tests/sessions/sample_session.h"
#include "tests/support/temporary_folder.h"

namespace elbowroom::control {
namespace {

namespace fs = std::filesystem;
using test_support::TemporaryFolder;

// Part of the demo: the hand meets the payload, and the gap is opened on the way.
void RecordDemo(const fs::path& session, FrameRange frames, const TrialSetup& setup) {
  TrialOptions options;
  options.session = session;
  options.frames = frames;
  TrialControls controls;
  (void)RunTrial(setup, options, controls, {});
}

ReplayOutcome Replayed(const fs::path& recorded, const fs::path& session, ReplayChanges changes = {},
                       FrameRange frames = {}) {
  const sessions::SessionReader reader = OpenWithOutcome(recorded, {}, {});
  return RunReplay(reader, {session, std::move(changes), frames}, {}, {});
}

constexpr FrameRange kWithTouches = {40, 130};

TEST(Replay, WithoutChangesHasTheRecordedRowsAndFindings) {
  const TemporaryFolder folder;
  RecordDemo(folder / "s.db", kWithTouches, MakeDemoTrial(DemoPlay::kOnce));
  const ReplayOutcome outcome = Replayed(folder / "s.db", folder / "again.db");
  EXPECT_EQ(outcome.frames, 90);
  EXPECT_TRUE(outcome.changes.empty());
  ASSERT_TRUE(outcome.compared.has_value());
  EXPECT_EQ(outcome.compared->frames_that_differ, 0);
  EXPECT_GT(outcome.contact_rows, 0);
  EXPECT_EQ(RowsThatDiffer(folder / "s.db", folder / "again.db"), 0);

  const sessions::SessionReader recorded(folder / "s.db"), again(folder / "again.db");
  ASSERT_FALSE(recorded.episodes().empty());
  ASSERT_EQ(again.episodes().size(), recorded.episodes().size());
  for (std::size_t i = 0; i < recorded.episodes().size(); ++i) {
    tests::ExpectEqual(again.episodes()[i], recorded.episodes()[i]);
    EXPECT_EQ(again.episodes()[i].finding_id, recorded.episodes()[i].finding_id);
  }
  ASSERT_EQ(again.near_misses().size(), recorded.near_misses().size());
  for (std::size_t i = 0; i < recorded.near_misses().size(); ++i)
    EXPECT_EQ(again.near_misses()[i].finding_id, recorded.near_misses()[i].finding_id);
  ASSERT_EQ(again.heat_maps().size(), recorded.heat_maps().size());
  EXPECT_EQ(again.heat_maps().front().dwell_s, recorded.heat_maps().front().dwell_s);
  EXPECT_EQ(again.events().size(), recorded.events().size());
  ASSERT_TRUE(again.header().origin.has_value());
  EXPECT_EQ(again.header().origin->recording_id, recorded.recording_id());
  EXPECT_EQ(again.first_recording_id(), recorded.recording_id());
}

// What the participant said is of the whole trial; a step that is under way where a part of it begins is
// marked there.
TEST(Replay, TakesOverTheProcedure) {
  const TemporaryFolder folder;
  TrialSetup setup = MakeDemoTrial(DemoPlay::kOnce);
  setup.info.steps = {"reach", "screw"};
  setup.info.survey = {{core::AskedWhen::kBefore, "sure?", 1, 7}};
  setup.opening = {core::EstimateGiven{core::AskedWhen::kBefore, 140.0},
                   core::SurveyAnswered{core::AskedWhen::kBefore, "sure?", 4}};
  setup.first_step = "screw";
  RecordDemo(folder / "s.db", {60, 70}, setup);
  sessions::AddAfterTrial(
      folder / "s.db", std::vector<core::EventContent>{core::EstimateGiven{core::AskedWhen::kAfter, 200.0}});
  (void)Replayed(folder / "s.db", folder / "again.db");
  const std::vector<core::SessionEvent> recorded = sessions::SessionReader(folder / "s.db").events();
  EXPECT_EQ(sessions::SessionReader(folder / "again.db").events(), recorded);
  EXPECT_EQ(RowsThatDiffer(folder / "s.db", folder / "again.db"), 0);
  (void)Replayed(folder / "s.db", folder / "part.db", {}, {64, 66});
  std::vector<core::SessionEvent> in_part = sessions::SessionReader(folder / "part.db").events();
  std::erase_if(in_part, [](const auto& event) {
    return std::holds_alternative<core::Note>(event.what) ||
           std::holds_alternative<core::ToolMarked>(event.what);
  });
  ASSERT_EQ(in_part.size(), 4U);
  EXPECT_EQ(in_part[0].what, setup.opening[0]);
  EXPECT_EQ(in_part[1].what, setup.opening[1]);
  EXPECT_EQ(in_part[2].what, core::EventContent(core::StepMarked{"screw", true}));
  EXPECT_EQ(in_part[2].frame, 64);
  EXPECT_EQ(in_part[3].what, core::EventContent(core::EstimateGiven{core::AskedWhen::kAfter, 200.0}));
}

TEST(Replay, FromTheFrameOfAStepsChangeHasTheNewStepOnly) {
  const TemporaryFolder folder;
  TrialSetup setup = MakeDemoTrial(DemoPlay::kOnce);
  setup.info.steps = {"reach", "screw"};
  setup.first_step = "reach";
  TrialOptions options;
  options.session = folder / "s.db";
  options.frames = {60, 70};
  TrialControls controls;
  options.on_frame = [&](const SharedFrameResult& result, const RecordedFrames&) {
    if (result->record.frame == 63) controls.BeginStep("screw");
  };
  (void)RunTrial(setup, options, controls, {});
  const auto runs_of = [](const fs::path& session) {
    return core::StepRunsOf(sessions::SessionReader(session).events());
  };
  const std::vector<core::StepRun> recorded = runs_of(folder / "s.db");
  ASSERT_EQ(recorded.size(), 2U);
  (void)Replayed(folder / "s.db", folder / "part.db", {}, {recorded[1].begin_frame, 70});
  const std::vector<core::StepRun> in_part = runs_of(folder / "part.db");
  ASSERT_EQ(in_part.size(), 1U);
  EXPECT_EQ(in_part[0].step, "screw");
  EXPECT_EQ(in_part[0].begin_frame, recorded[1].begin_frame);
}

// The comparison in memory must see what the files show.
TEST(Replay, TellsRowsThatWereChangedInTheRecording) {
  const TemporaryFolder folder;
  RecordDemo(folder / "s.db", {60, 75}, MakeDemoTrial(DemoPlay::kOnce));
  {
    SQLite::Database database((folder / "s.db").string(), SQLite::OPEN_READWRITE);
    database.exec("UPDATE part_frame SET queries = queries + 1 WHERE frame_index = 70 AND part_index = 0");
  }
  const ReplayOutcome outcome = Replayed(folder / "s.db", folder / "again.db");
  ASSERT_TRUE(outcome.compared.has_value());
  EXPECT_EQ(outcome.compared->frames_that_differ, 1);
  EXPECT_EQ(outcome.compared->first_that_differs, 70);
  EXPECT_GT(RowsThatDiffer(folder / "s.db", folder / "again.db"), 0);
}

TEST(Replay, OfSomeFramesHasTheRecordedRowsOfThese) {
  const TemporaryFolder folder;
  RecordDemo(folder / "s.db", kWithTouches, MakeDemoTrial(DemoPlay::kOnce));
  const ReplayOutcome outcome = Replayed(folder / "s.db", folder / "part.db", {}, {77, 103});
  EXPECT_EQ(outcome.frames, 26);
  ASSERT_TRUE(outcome.compared.has_value());
  EXPECT_EQ(outcome.compared->frames_that_differ, 0);
  EXPECT_EQ(RowsThatDiffer(folder / "s.db", folder / "part.db", "frame_index BETWEEN 77 AND 102"), 0);
}

TEST(Replay, IsTheSameForOneThreadAndForMany) {
  const TemporaryFolder folder;
  RecordDemo(folder / "s.db", {60, 90}, MakeDemoTrial(DemoPlay::kOnce));
  const ReplayChanges changes{.held_mm = {{MakeDemoTrial(DemoPlay::kOnce).layout.spacings[0].name, 150.0}}};
  (void)Replayed(folder / "s.db", folder / "many.db", changes);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  (void)Replayed(folder / "s.db", folder / "one.db", changes);
  EXPECT_EQ(RowsThatDiffer(folder / "one.db", folder / "many.db"), 0);
}

// A replay at another gap is held to a trial at that gap: contacts are the same, and bounds hold the same
// distances, though the searches began elsewhere. (Where within the tolerance the bounds fall may decide
// between `near`, `undecided` and `clear`.)
TEST(Replay, AtAnotherGapIsATrialAtThatGap) {
  const TemporaryFolder folder;
  TrialSetup setup = MakeDemoTrial(DemoPlay::kOnce);
  setup.script.clear();
  RecordDemo(folder / "s.db", {60, 100}, setup);
  constexpr double kGapMm = 160.0;
  TrialSetup other = MakeDemoTrial(DemoPlay::kOnce);
  other.script.clear();
  other.layout.spacings[0].initial_mm = kGapMm;
  RecordDemo(folder / "trial.db", {60, 100}, other);
  (void)Replayed(folder / "s.db", folder / "replay.db",
                 {.held_mm = {{setup.layout.spacings[0].name, kGapMm}}});
  const sessions::SessionReader trial(folder / "trial.db"), replay(folder / "replay.db");
  for (core::FrameIndex frame = 60; frame < 100; ++frame) {
    const core::FrameRecord a = trial.ReadFrame(frame), b = replay.ReadFrame(frame);
    EXPECT_EQ(a.spacing_mm, b.spacing_mm);
    for (core::PartIndex i = 0; i < a.contacts.size(); ++i) {
      const bool is_contact = a.contacts[i].verdict == core::Verdict::kContact;
      EXPECT_EQ(is_contact, b.contacts[i].verdict == core::Verdict::kContact) << frame;
      EXPECT_EQ(a.contacts[i].contact_area_mm2, b.contacts[i].contact_area_mm2);
      ASSERT_EQ(a.contacts[i].clearance.has_value(), b.contacts[i].clearance.has_value());
      if (!a.contacts[i].clearance) continue;
      EXPECT_LE(a.contacts[i].clearance->interval.lower_mm, b.contacts[i].clearance->interval.upper_mm);
      EXPECT_LE(b.contacts[i].clearance->interval.lower_mm, a.contacts[i].clearance->interval.upper_mm);
    }
  }
  ASSERT_TRUE(replay.header().origin.has_value());
  EXPECT_EQ(replay.header().origin->changes.size(), 1U);
}

TEST(Replay, OfPartsThatGiveWayTakesTheSameSteps) {
  const TemporaryFolder folder;
  TrialSetup setup = MakeDemoTrial(DemoPlay::kOnce);
  setup.layout.parts[1].gives_way = core::PushRule{};
  RecordDemo(folder / "s.db", {60, 85}, setup);
  const ReplayOutcome all = Replayed(folder / "s.db", folder / "all.db");
  ASSERT_TRUE(all.compared.has_value());
  EXPECT_EQ(all.compared->frames_that_differ, 0);
  EXPECT_EQ(RowsThatDiffer(folder / "s.db", folder / "all.db"), 0);
  SQLite::Database database((folder / "s.db").string());
  EXPECT_GT(database.execAndGet("SELECT count(*) FROM part_motion").getInt64(), 0);
  const ReplayOutcome some = Replayed(folder / "s.db", folder / "some.db", {}, {75, 80});
  EXPECT_EQ(some.frames, 5);
  EXPECT_EQ(some.compared->frames_that_differ, 0);
}

TEST(Replay, LeavesNoFileWhenItIsStoppedAndTakesNoNameThatIsTaken) {
  const TemporaryFolder folder;
  RecordDemo(folder / "s.db", {60, 70}, MakeDemoTrial(DemoPlay::kOnce));
  const sessions::SessionReader reader = OpenWithOutcome(folder / "s.db", {}, {});
  std::stop_source stop;
  const core::Progress progress([&](std::int64_t, std::int64_t, const std::string&) { stop.request_stop(); });
  EXPECT_THROW((void)RunReplay(reader, {folder / "new.db", {}, {}}, progress, stop.get_token()), core::Error);
  EXPECT_FALSE(fs::exists(folder / "new.db"));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator()), 1);
  EXPECT_THROW((void)RunReplay(reader, {folder / "s.db", {}, {}}, {}, {}), core::Error);
}

TEST(Replay, KeepsWhatReviewersSaid) {
  const TemporaryFolder folder;
  constexpr FrameRange kFromTheBegin = {0, 70};
  RecordDemo(folder / "s.db", kFromTheBegin, MakeDemoTrial(DemoPlay::kOnce));
  std::string id;
  double before = 0.0;
  {
    const sessions::SessionReader reader(folder / "s.db");
    id = reader.findings().back().id;
    before = reader.findings().back().begin_s;
    SQLite::Database database((folder / "s.db").string(), SQLite::OPEN_READWRITE);
    database.exec("INSERT INTO remark (finding_id, at_utc, by_name, status, comment) VALUES ('" + id +
                  "', '2026-01-01T00:00:00Z', 'Ann', 'approved', 'fine')");
  }
  (void)Replayed(folder / "s.db", folder / "again.db");
  // Frames after which nothing of it was judged.
  const sessions::SessionReader whole(folder / "s.db");
  core::FrameIndex end = 0;
  for (const sessions::FrameSummary& frame : whole.frames())
    if (frame.time_s < before) end = frame.frame;
  ASSERT_GT(end, kFromTheBegin.first);
  const ReplayOutcome part = Replayed(folder / "s.db", folder / "part.db", {}, {kFromTheBegin.first, end});
  ASSERT_FALSE(part.absent.empty());
  for (const fs::path& file : {folder / "again.db", folder / "part.db"}) {
    const sessions::SessionReader reader(file);
    const auto findings = reader.findings();
    const auto kept = std::ranges::find(findings, id, &core::Finding::id);
    ASSERT_NE(kept, findings.end());
    EXPECT_EQ(kept->status(), core::ReviewStatus::kApproved);
    EXPECT_EQ(kept->remarks.size(), 1U);
    EXPECT_EQ(kept->presence, file == folder / "again.db" ? core::FindingPresence::kHere
                                                          : core::FindingPresence::kNotChecked);
    for (const core::Finding& finding : findings) {
      if (finding.presence != core::FindingPresence::kNotChecked) continue;
      EXPECT_NE(finding.status(), core::ReviewStatus::kResolved);
    }
  }
}

}  // namespace
}  // namespace elbowroom::control
