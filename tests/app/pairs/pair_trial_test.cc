// A gap moved while a trial runs: its frames, its session, its replays, its report.
#include <gtest/gtest.h>

#include <algorithm>
#include <variant>

#include "app/control/demo_parts.h"
#include "app/control/demo_trial.h"
#include "app/control/outcome_tracker.h"
#include "app/control/pairs/pair_record.h"
#include "app/control/pairs/ruled_pairs.h"
#include "app/control/replay/replay.h"
#include "app/control/report/session_report.h"
#include "app/control/trial_runner.h"
#include "sessions/session_reader.h"
#include "tests/app/pairs/ruled_layouts.h"
#include "tests/app/replay/session_rows.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_file.h"

namespace elbowroom::control {
namespace {

namespace fs = std::filesystem;

constexpr core::FrameIndex kNarrowed = 8, kWidened = 20, kFrames = 30;
constexpr double kRequiredMm = 100.0;

// The demo, in which payload A must stay 100 mm from the PMT box; the gap is narrowed and widened again.
TrialSetup NarrowedDemo() {
  TrialSetup setup = MakeDemoTrial(DemoPlay::kOnce);
  setup.layout.pair_rules[0].required_clearance_mm = kRequiredMm;
  setup.script = {{kNarrowed, SpacingRequest{kDemoGap, 70.0}},
                  {kNarrowed + 4, SpacingRequest{kDemoGap, 75.0}},
                  {kWidened, SpacingRequest{kDemoGap, 150.0}}};
  return setup;
}

class PairTrialTest : public ::testing::Test {
 protected:
  TrialOutcome Run(const TrialSetup& setup, const std::string& session, bool at_capture_rate = false) {
    TrialOptions options;
    options.session = folder_ / session;
    options.frames = {0, kFrames};
    options.at_capture_rate = at_capture_rate;
    options.on_frame = [&](const SharedFrameResult& result, const RecordedFrames&) {
      results_.push_back(result);
    };
    TrialControls controls;
    return RunTrial(setup, options, controls, {});
  }

  ReplayOutcome Replayed(const std::string& session, ReplayChanges changes = {}, FrameRange frames = {}) {
    const sessions::SessionReader reader = OpenWithOutcome(folder_ / "s.db", {}, {});
    return RunReplay(reader, {folder_ / session, std::move(changes), frames}, {}, {});
  }

  // "frame: text" of each.
  std::vector<std::string> PairNotes(const std::string& session) const {
    std::vector<std::string> notes;
    for (const core::SessionEvent& event : sessions::SessionReader(folder_ / session).events())
      if (IsPairNote(event))
        notes.push_back(std::to_string(event.frame) + ": " + std::get<core::Note>(event.what).text);
    return notes;
  }

  test_support::TemporaryFolder folder_;
  std::vector<SharedFrameResult> results_;
};

using Texts = std::vector<std::string>;
const Texts kNotes = {
    "8: pair rule broken: 'pmt' and 'payload_a' near, 70.00 mm apart, 100 mm required",
    "20: pair rule kept again: 'pmt' and 'payload_a' clear, at least 150.00 mm apart, 100 mm "
    "required"};

TEST_F(PairTrialTest, ABrokenRuleIsInTheVeryFrameThatHasTheGap) {
  const TrialSetup setup = NarrowedDemo();
  const TrialOutcome outcome = Run(setup, "s.db");
  ASSERT_EQ(results_.size(), static_cast<std::size_t>(kFrames));
  for (const SharedFrameResult& result : results_) {
    const core::FrameIndex frame = result->record.frame;
    SCOPED_TRACE(frame);
    ASSERT_NE(result->pairs, nullptr);
    EXPECT_EQ(result->pairs->setting.spacing_mm, result->record.spacing_mm);
    testing::ExpectSame(result->pairs->pairs,
                        testing::JudgedAnew(setup.layout, result->record.spacing_mm).pairs);
    EXPECT_EQ(IsBroken(result->pairs->pairs[0]), frame >= kNarrowed && frame < kWidened);
    const bool is_new = frame == 0 || frame == kNarrowed || frame == kNarrowed + 4 || frame == kWidened;
    EXPECT_EQ(result->skipped.pairs.pairs, 3);
    EXPECT_EQ(result->skipped.pairs.unchanged, frame == 0 ? 0 : is_new ? 1 : 3);
  }
  EXPECT_EQ(PairNotes("s.db"), kNotes);
  ASSERT_EQ(outcome.pairs.size(), 3U);
  EXPECT_TRUE(outcome.pairs[0].was_broken);
  EXPECT_NEAR(outcome.pairs[0].closest.gap->distance_mm, 70.0, 1e-9);
  EXPECT_NEAR(outcome.pairs[0].broken_s,
              results_[kWidened]->record.time_s - results_[kNarrowed]->record.time_s, 1e-9);
  EXPECT_FALSE(outcome.pairs[1].was_broken);
  EXPECT_EQ(outcome.skipped.pairs.pairs, 3 * kFrames);
}

TEST_F(PairTrialTest, AtTheRateOfTheCamerasTheNotesAreTheSame) {
  (void)Run(NarrowedDemo(), "s.db", true);
  EXPECT_EQ(PairNotes("s.db"), kNotes);
  for (const SharedFrameResult& result : results_) {
    if (!result->pairs) continue;
    EXPECT_LE(result->pairs->setting.frame, result->record.frame);
  }
}

TEST_F(PairTrialTest, AReplayHasTheRecordedNotes) {
  (void)Run(NarrowedDemo(), "s.db");
  const ReplayOutcome outcome = Replayed("again.db");
  ASSERT_TRUE(outcome.compared);
  EXPECT_EQ(outcome.compared->frames_that_differ, 0);
  EXPECT_EQ(RowsThatDiffer(folder_ / "s.db", folder_ / "again.db"), 0);
  EXPECT_EQ(PairNotes("again.db"), kNotes);
}

TEST_F(PairTrialTest, AReplayOfSomeFramesTellsWhatIsBrokenWhenItBegins) {
  (void)Run(NarrowedDemo(), "s.db");
  const ReplayOutcome outcome = Replayed("part.db", {}, {15, std::nullopt});
  ASSERT_TRUE(outcome.compared);
  EXPECT_EQ(outcome.compared->frames_that_differ, 0);
  EXPECT_EQ(PairNotes("part.db"),
            Texts({"15: pair rule broken: 'pmt' and 'payload_a' near, 75.00 mm apart, 100 mm required",
                   kNotes[1]}));
}

TEST_F(PairTrialTest, AReplayAtAnotherGapHasTheNotesOfThatGap) {
  (void)Run(NarrowedDemo(), "s.db");
  (void)Replayed("wide.db", {.held_mm = {{kDemoGap, 150.0}}});
  EXPECT_EQ(PairNotes("wide.db"), Texts());
  (void)Replayed("narrow.db", {.held_mm = {{kDemoGap, 90.0}}});
  EXPECT_EQ(PairNotes("narrow.db"),
            Texts({"0: pair rule broken: 'pmt' and 'payload_a' near, 90.00 mm apart, 100 mm required"}));
}

TEST_F(PairTrialTest, ALayoutWithoutRulesHasNoVerdicts) {
  TrialSetup setup = NarrowedDemo();
  setup.layout.pair_rules.clear();
  const TrialOutcome outcome = Run(setup, "s.db");
  EXPECT_EQ(results_.back()->pairs, nullptr);
  EXPECT_TRUE(outcome.pairs.empty());
  EXPECT_EQ(outcome.skipped.pairs.pairs, 0);
  EXPECT_EQ(PairNotes("s.db"), Texts());
}

TEST_F(PairTrialTest, TheReportListsIt) {
  (void)Run(NarrowedDemo(), "s.db");
  (void)WriteSessionReport(folder_ / "s.db", folder_ / "out", {}, {});
  const std::string page = test_support::ReadText(folder_ / "out" / "report.html");
  EXPECT_NE(page.find("pair rule broken: "), std::string::npos);
  EXPECT_NE(page.find("near, 70.00 mm apart, 100 mm required"), std::string::npos);
  EXPECT_NE(page.find("Parts against parts"), std::string::npos);
}

}  // namespace
}  // namespace elbowroom::control
