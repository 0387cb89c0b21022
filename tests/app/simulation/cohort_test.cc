// A simulated cohort: planned and recorded from its seed alone.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <stop_token>

#include "app/control/simulation/cohort.h"
#include "app/control/simulation/cohort_recording.h"
#include "core/error.h"
#include "sessions/row_comparison.h"
#include "sessions/session_reader.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_file.h"

namespace elbowroom {
namespace {

namespace fs = std::filesystem;
using control::CohortOptions, control::CohortTask, control::PlanCohort, control::SimulatedTrial;

CohortOptions Short(CohortTask task, int participants) {
  CohortOptions options = CohortOptions::Of(task);
  options.participants = participants;
  options.seconds = task == CohortTask::kPayload ? 1.5 : 0.5;
  options.frame_rate_hz = 8.0;
  return options;
}

TEST(CohortPlan, ADifferentPersonEachTimeAndTheSameFromTheSeed) {
  for (const CohortTask task : control::kCohortTasks) {
    const auto trials = PlanCohort(Short(task, 8)), again = PlanCohort(Short(task, 8));
    std::set<double> needed_mm, lengths;
    ASSERT_EQ(trials.size(), again.size());
    for (std::size_t i = 0; i < trials.size(); ++i) {
      EXPECT_EQ(trials[i].truth.needed_mm, again[i].truth.needed_mm);
      EXPECT_EQ(trials[i].frames, again[i].frames);
      needed_mm.insert(trials[i].truth.needed_mm);
    }
    EXPECT_GE(needed_mm.size(), 8U) << "each has a way of their own";
    CohortOptions other = Short(task, 8);
    other.seed = 2;
    EXPECT_NE(PlanCohort(other).front().truth.needed_mm, trials.front().truth.needed_mm);
    // Who is added changes nothing for those before.
    const auto more = PlanCohort(Short(task, 11));
    for (std::size_t i = 0; i < trials.size(); ++i) {
      EXPECT_EQ(more[i].truth.needed_mm, trials[i].truth.needed_mm);
      EXPECT_EQ(more[i].setup.info.condition, trials[i].setup.info.condition);
    }
  }
}

TEST(CohortPlan, OfEachFourOneFeedsTheCableByHand) {
  int tongs = 0, taller = 0;
  for (const SimulatedTrial& trial : PlanCohort(Short(CohortTask::kPayload, 40))) {
    EXPECT_LE(trial.truth.needed_without_tools_mm, trial.truth.needed_mm);
    if (trial.setup.info.condition == "stiff cable") {
      EXPECT_EQ(trial.truth.needed_without_tools_mm, trial.truth.needed_mm);
      continue;
    }
    ++tongs;
    taller += trial.truth.needed_without_tools_mm < trial.truth.needed_mm ? 1 : 0;
  }
  EXPECT_EQ(tongs, 30);
  EXPECT_GT(taller, 15) << "tongs need more room, for most";
}

TEST(CohortPlan, BlocksFollowThePapersProcedure) {
  const auto trials = PlanCohort(Short(CohortTask::kBlocks, 4));
  std::map<std::string, std::map<std::string, int>> by_condition;  // tasks
  std::map<std::string, std::set<std::string>> hybrid_of;
  int order = 0;
  std::string participant;
  for (const SimulatedTrial& trial : trials) {
    const core::TrialInfo& info = trial.setup.info;
    if (info.participant != participant) order = 0;
    participant = info.participant;
    EXPECT_EQ(info.order, ++order);
    ++by_condition[info.condition][info.task];
    if (info.condition != "real") hybrid_of[participant].insert(info.condition);
    EXPECT_TRUE(info.condition == "real" || order > 12) << "real space comes first";
    EXPECT_GT(*trial.truth.pattern_s, 0.0);
  }
  for (const char* task : {"2 x 2, practice", "3 x 3, practice", "2 x 2, timed", "3 x 3, timed"}) {
    EXPECT_EQ(by_condition["real"][task], 3 * 4);
    EXPECT_EQ(by_condition["generic hands"][task], 2 * 2);
    EXPECT_EQ(by_condition["faithful hands"][task], 2 * 2);
  }
  for (const auto& [who, hybrids] : hybrid_of)
    EXPECT_EQ(hybrids.size(), 1U) << who << ": between participants";
}

TEST(CohortPlan, RefusesWhatIsOutOfRange) {
  for (const auto change :
       {+[](CohortOptions* o) { o->participants = 0; }, +[](CohortOptions* o) { o->seconds = 0.0; },
        +[](CohortOptions* o) { o->frame_rate_hz = 0.0; }}) {
    CohortOptions options;
    change(&options);
    EXPECT_THROW((void)PlanCohort(options), core::PreconditionError);
  }
}

// All that a session has of its motion, and what was judged of it.
void ExpectSameRows(const fs::path& a_path, const fs::path& b_path) {
  const sessions::SessionReader a(a_path), b(b_path);
  ASSERT_EQ(a.frame_count(), b.frame_count());
  for (const auto& summary : a.frames()) {
    const core::FrameRecord of_a = a.ReadFrame(summary.frame), of_b = b.ReadFrame(summary.frame);
    EXPECT_EQ(of_a.time_s, of_b.time_s);
    EXPECT_TRUE(*of_a.masks == *of_b.masks) << summary.frame;
    EXPECT_TRUE(sessions::CompareRows(of_a, of_b).are_equal) << summary.frame;
  }
  EXPECT_TRUE(a.events() == b.events());
  EXPECT_EQ(a.episodes().size(), b.episodes().size());
}

TEST(CohortRecording, TheSameSeedGivesTheSameRowsOnAnyNumberOfThreads) {
  const test_support::TemporaryFolder folder;
  const CohortOptions options = Short(CohortTask::kPayload, 3);
  const auto first = control::RecordCohort(options, folder / "a", {}, {});
  {
    const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
    (void)control::RecordCohort(options, folder / "b", {}, {});
  }
  ASSERT_EQ(first.sessions.size(), 3U);
  for (const fs::path& session : first.sessions) ExpectSameRows(session, folder / "b" / session.filename());
  EXPECT_EQ(test_support::ReadText(folder / "a/truth.csv"), test_support::ReadText(folder / "b/truth.csv"));
}

TEST(CohortRecording, ASessionSaysWhoDidWhatAndThatItIsSimulated) {
  const test_support::TemporaryFolder folder;
  const auto cohort = control::RecordCohort(Short(CohortTask::kPayload, 2), folder.path(), {}, {});
  const sessions::SessionReader session(cohort.sessions.back());
  const core::TrialInfo& info = session.header().trial;
  EXPECT_EQ(info.participant, "P02");
  EXPECT_EQ(info.order, 1);
  EXPECT_EQ(info.estimate_mm, *cohort.trials.back().truth.estimate_before_mm);
  EXPECT_EQ(session.frame_count(), cohort.trials.back().frames);
  bool says_so = false;
  std::size_t steps = 0;
  for (const core::SessionEvent& event : session.events()) {
    if (const auto* note = std::get_if<core::Note>(&event.what))
      says_so = says_so || note->text.starts_with("simulated: task payload, seed 1");
    steps += std::holds_alternative<core::StepMarked>(event.what) ? 1 : 0;
  }
  EXPECT_TRUE(says_so);
  EXPECT_EQ(steps, 4U) << "two steps, begun and ended";
}

TEST(CohortRecording, StoppedItKeepsWholeSessionsAndGoesOn) {
  const test_support::TemporaryFolder folder;
  const CohortOptions options = Short(CohortTask::kPayload, 6);
  std::stop_source stop;
  const core::Progress stop_after_one([&](std::int64_t done, std::int64_t, const std::string& what) {
    if (what == "sessions" && done >= 1) stop.request_stop();
  });
  EXPECT_THROW((void)control::RecordCohort(options, folder.path(), stop_after_one, stop.get_token()),
               core::Error);
  const auto trials = PlanCohort(options);
  std::int64_t whole = 0;
  for (const SimulatedTrial& trial : trials) {
    if (!fs::exists(folder / trial.file)) continue;
    EXPECT_EQ(sessions::SessionReader(folder / trial.file).frame_count(), trial.frames);
    ++whole;
  }
  EXPECT_GE(whole, 1);
  EXPECT_LT(whole, 6);
  EXPECT_FALSE(fs::exists(folder / "truth.csv"));
  const auto rest = control::RecordCohort(options, folder.path(), {}, {});
  EXPECT_EQ(rest.kept, whole);
  EXPECT_TRUE(fs::exists(folder / "truth.csv"));
}

}  // namespace
}  // namespace elbowroom
