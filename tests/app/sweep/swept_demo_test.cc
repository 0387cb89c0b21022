// The demo's own trial, swept: equal to replays, and whatever kills it.
#include <gtest/gtest.h>
#include <signal.h>

#include <cmath>
#include <filesystem>
#include <map>
#include <memory>
#include <thread>

#include "app/control/demo_parts.h"
#include "app/control/demo_trial.h"
#include "app/control/replay/replay.h"
#include "app/control/trial_runner.h"
#include "sessions/session_reader.h"
#include "tests/app/sweep/swept_sessions.h"
#include "tests/support/temporary_folder.h"

namespace elbowroom::tests {
namespace {

namespace fs = std::filesystem;
using test_support::ProgramRun;

constexpr const char* kDemoRange = "payload_a_gap=100:300:5";
// Of a clearance's bounds in a trial and a replay.
constexpr double kBoundsToleranceMm = 1.0;

// The first 400 frames of the demo's trial: all of the task at 140 mm, some at 240 mm; two files of cells.
class SweptDemo : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<test_support::TemporaryFolder>();
    control::TrialOptions options;
    options.session = Session();
    options.frames = {0, 400};
    control::TrialControls controls;
    (void)control::RunTrial(control::MakeDemoTrial(control::DemoPlay::kOnce), options, controls, {});
    const ProgramRun run = RunSweep({Session()}, kDemoRange, *folder_ / "whole", {"--json"});
    ASSERT_EQ(run.exit_status, 0) << run.err;
    whole_ = nlohmann::json::parse(run.out);
  }
  static void TearDownTestSuite() { folder_.reset(); }
  [[nodiscard]] static fs::path Session() { return *folder_ / "s.db"; }

  static std::unique_ptr<test_support::TemporaryFolder> folder_;
  static nlohmann::json whole_;
};
std::unique_ptr<test_support::TemporaryFolder> SweptDemo::folder_;
nlohmann::json SweptDemo::whole_;

struct Counts {
  std::map<core::Verdict, std::int64_t> frames;
  double deepest_mm = 0.0;
  double lower_mm = std::numeric_limits<double>::infinity();
  double upper_mm = std::numeric_limits<double>::infinity();
};

// What a replay at this value records, a part each.
std::vector<Counts> ReplayedAt(const fs::path& session, const fs::path& replayed, double spacing_mm) {
  const sessions::SessionReader recorded(session);
  control::ReplayOptions options;
  options.session = replayed;
  options.changes.held_mm = {{control::kDemoGap, spacing_mm}};
  (void)control::RunReplay(recorded, options, {}, {});
  const sessions::SessionReader reader(replayed);
  std::vector<Counts> counts(reader.header().layout.parts.size());
  for (const sessions::FrameSummary& frame : reader.frames()) {
    for (const core::PartContact& contact : reader.ReadFrame(frame.frame).contacts) {
      Counts& of_part = counts[contact.part];
      ++of_part.frames[contact.verdict];
      if (contact.deepest) of_part.deepest_mm = std::max(of_part.deepest_mm, contact.deepest->depth_mm);
      of_part.lower_mm = std::min(of_part.lower_mm, contact.clearance->interval.lower_mm);
      of_part.upper_mm = std::min(of_part.upper_mm, contact.clearance->interval.upper_mm);
    }
  }
  return counts;
}

TEST_F(SweptDemo, IsWhatReplaysSayAtFiveOfItsValues) {
  ASSERT_EQ(whole_["steps"].size(), 41U);
  for (const std::size_t step : {0U, 9U, 22U, 26U, 40U}) {
    const auto& at = whole_["steps"][step];
    const double spacing_mm = at["spacing_mm"];
    SCOPED_TRACE(spacing_mm);
    const auto replayed = ReplayedAt(Session(), *folder_ / ("at" + std::to_string(step) + ".db"), spacing_mm);
    for (std::size_t i = 0; i < replayed.size(); ++i) {
      SCOPED_TRACE(at["parts"][i]["part"].get<std::string>());
      const auto& swept = at["parts"][i];
      Counts expected = replayed[i];
      EXPECT_EQ(swept["frames_in_contact"], expected.frames[core::Verdict::kContact]);
      EXPECT_EQ(swept["frames_near"], expected.frames[core::Verdict::kNear]);
      EXPECT_EQ(swept["frames_undecided"], expected.frames[core::Verdict::kUndecided]);
      EXPECT_EQ(swept["frames_clear"], expected.frames[core::Verdict::kClear]);
      EXPECT_EQ(swept["deepest_mm"], expected.deepest_mm);
      const double lower_mm = swept["lower_mm"], upper_mm = swept["upper_mm"];
      EXPECT_LE(upper_mm - lower_mm, kBoundsToleranceMm + 1e-9);
      EXPECT_LE(lower_mm, expected.upper_mm + 1e-9);
      EXPECT_LE(expected.lower_mm, upper_mm + 1e-9);
    }
  }
}

TEST_F(SweptDemo, ToolsSplitTheFrames) {
  ASSERT_EQ(whole_["tools"].size(), 2U);
  const auto &without = whole_["tools"][0], &tongs = whole_["tools"][1];
  EXPECT_TRUE(without["tool"].is_null());
  EXPECT_EQ(tongs["tool"], "tongs");
  EXPECT_GT(tongs["frames"], 0);
  EXPECT_EQ(without["frames"].get<int>() + tongs["frames"].get<int>(), 400);
  EXPECT_EQ(whole_["smallest_free_mm"],
            std::max(without["smallest_free_mm"].get<double>(), tongs["smallest_free_mm"].get<double>()));
  for (std::size_t step = 0; step < 41; ++step)
    for (const char* key : {"frames_in_contact", "frames_near", "frames_undecided", "frames_clear"})
      EXPECT_EQ(without["steps"][step]["parts"][1][key].get<int>() +
                    tongs["steps"][step]["parts"][1][key].get<int>(),
                whole_["steps"][step]["parts"][1][key].get<int>());
}

// Killed once the first cell is kept.
ProgramRun SweepAndKill(const fs::path& session, const fs::path& out, int signal) {
  test_support::RunOptions options;
  options.while_running = [&](int process) {
    while (CellFiles(out).empty() && kill(process, 0) == 0)
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    kill(process, signal);
  };
  return RunSweep({session}, kDemoRange, out, {"--threads", "1"}, options);
}

class EndedSweep : public SweptDemo, public testing::WithParamInterface<int> {};

TEST_P(EndedSweep, GoesOnAndGivesTheSameBytes) {
  const fs::path out = *folder_ / ("ended" + std::to_string(GetParam()));
  const ProgramRun ended = SweepAndKill(Session(), out, GetParam());
  EXPECT_EQ(ended.exit_status, GetParam() == SIGKILL ? 128 + SIGKILL : 1) << ended.err;
  EXPECT_FALSE(fs::exists(out / "sweep.csv"));
  const std::size_t kept = CellFiles(out).size();
  ASSERT_GE(kept, 1U);
  ASSERT_LT(kept, CellFiles(*folder_ / "whole").size()) << "it was through before it was ended";
  const ProgramRun again = RunSweep({Session()}, kDemoRange, out, {"--json"});
  ASSERT_EQ(again.exit_status, 0) << again.err;
  auto json = nlohmann::json::parse(again.out);
  EXPECT_GE(json["cells_from_before"], 1);
  EXPECT_LT(json["cells_from_before"], json["cells"]);
  ExpectSameSweep(out, *folder_ / "whole");
  auto whole = whole_;
  for (const char* key : {"cells_from_before", "files", "hulls"}) {
    json.erase(key);
    whole.erase(key);
  }
  EXPECT_EQ(json, whole);
}

INSTANTIATE_TEST_SUITE_P(Signals, EndedSweep, testing::Values(SIGKILL, SIGINT, SIGTERM));

}  // namespace
}  // namespace elbowroom::tests
