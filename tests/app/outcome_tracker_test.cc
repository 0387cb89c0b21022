#include "app/control/outcome_tracker.h"

#include <SQLiteCpp/SQLiteCpp.h>
#include <gtest/gtest.h>

#include <memory>

#include "app/control/demo_trial.h"
#include "app/control/trial_runner.h"
#include "sessions/session_reader.h"
#include "tests/sessions/sample_session.h"
#include "tests/support/temporary_folder.h"

namespace elbowroom::control {
namespace {

// The demo from where the hand first meets the payload; the tongs are taken up on the way.
void RecordPartOfTheDemo(const std::filesystem::path& session) {
  const TrialSetup setup = MakeDemoTrial(DemoPlay::kOnce);
  TrialOptions options;
  options.session = session;
  options.frames = {40, 130};
  TrialControls controls;
  (void)RunTrial(setup, options, controls, {});
}

// As a program leaves it that dies before the end.
void CutOff(const std::filesystem::path& session) {
  SQLite::Database database(session.string(), SQLite::OPEN_READWRITE);
  database.exec(
      "PRAGMA foreign_keys = OFF; DELETE FROM episode; DELETE FROM episode_spacing; DELETE FROM near_miss; "
      "DELETE FROM heat_map; UPDATE session SET ended_at_utc = NULL, status = 'recording'");
}

TEST(OutcomeFromFrames, IsTheOutcomeThatTheTrialWouldHaveHad) {
  const test_support::TemporaryFolder folder;
  RecordPartOfTheDemo(folder / "s.db");
  const auto whole = std::make_unique<sessions::SessionReader>(folder / "s.db");
  const auto episodes = whole->episodes();
  const auto near_misses = whole->near_misses();
  const auto heat_maps = whole->heat_maps();
  ASSERT_FALSE(episodes.empty());
  ASSERT_FALSE(heat_maps.empty());
  CutOff(folder / "s.db");
  const sessions::SessionReader rebuilt = OpenWithOutcome(folder / "s.db", {}, {});
  EXPECT_EQ(rebuilt.status(), sessions::SessionStatus::kCutOff);
  EXPECT_TRUE(rebuilt.has_outcome());
  ASSERT_EQ(rebuilt.episodes().size(), episodes.size());
  for (std::size_t i = 0; i < episodes.size(); ++i) tests::ExpectEqual(rebuilt.episodes()[i], episodes[i]);
  ASSERT_EQ(rebuilt.near_misses().size(), near_misses.size());
  for (std::size_t i = 0; i < near_misses.size(); ++i)
    tests::ExpectEqual(rebuilt.near_misses()[i], near_misses[i]);
  ASSERT_EQ(rebuilt.heat_maps().size(), heat_maps.size());
  for (std::size_t i = 0; i < heat_maps.size(); ++i) {
    EXPECT_EQ(rebuilt.heat_maps()[i].part, heat_maps[i].part);
    EXPECT_EQ(rebuilt.heat_maps()[i].dwell_s, heat_maps[i].dwell_s);
    EXPECT_EQ(rebuilt.heat_maps()[i].peak_depth_mm, heat_maps[i].peak_depth_mm);
  }
}

}  // namespace
}  // namespace elbowroom::control
