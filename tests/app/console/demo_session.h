// A session of the demo, for tests of the review page.
#pragma once

#include <filesystem>

#include "app/control/demo_trial.h"
#include "app/control/trial_runner.h"
#include "tests/support/temporary_folder.h"

namespace elbowroom::console {

// The first time that the hand meets the payload, recorded once. It isn't to be changed.
inline std::filesystem::path DemoSession() {
  static const test_support::TemporaryFolder folder;
  const std::filesystem::path session = folder / "demo.db";
  if (std::filesystem::exists(session)) return session;
  control::TrialOptions options;
  options.session = session;
  options.frames = {20, 120};
  control::TrialControls controls;
  (void)control::RunTrial(control::MakeDemoTrial(control::DemoPlay::kOnce), options, controls, {});
  return session;
}

}  // namespace elbowroom::console
