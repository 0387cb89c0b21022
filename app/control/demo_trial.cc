#include "app/control/demo_trial.h"

#include <cmath>

#include "app/control/demo_parts.h"
#include "recon/synthetic/demo_motion.h"
#include "recon/synthetic/rig_presets.h"
#include "recon/synthetic/synthetic_rig.h"

namespace elbowroom::control {
namespace {

// Between the parts on one side and the hand and its tools on the other.
constexpr double kRequiredClearanceMm = 15.0;
// The paper knows of the designers' guesses that they were 5.6 cm too little on average.
constexpr double kEstimateMm = kGapNeededMm - 56.0;

// When the simulated hand takes up the tongs and lays them down.
std::vector<ScriptedChange> ToolChanges(core::FrameIndex frames, double frame_rate_hz) {
  std::vector<ScriptedChange> changes;
  bool in_use = false;
  for (core::FrameIndex frame = 0; frame < frames; ++frame) {
    const bool now = recon::DemoSceneAt(static_cast<double>(frame) / frame_rate_hz).tongs_in_use;
    if (now != in_use) changes.push_back({frame, ToolRequest{"tongs", now}});
    in_use = now;
  }
  return changes;
}

}  // namespace

TrialSetup MakeDemoTrial(DemoPlay play) {
  recon::SyntheticRigOptions options;
  const auto frames_a_task =
      static_cast<core::FrameIndex>(std::lround(recon::kTaskSeconds * options.frame_rate_hz));
  TrialSetup setup;
  setup.info = {.participant = "simulated hand",
                .task = "screw the pipe into the PMT box, then plug the power cable in with tongs",
                .estimate_mm = kEstimateMm,
                .required_clearance_mm = kRequiredClearanceMm,
                .tools = {"tongs"},
                .uncertainty_mm = 0.0};
  setup.layout = DemoLayout();
  if (play == DemoPlay::kOnce) {
    options.frame_count = 2 * frames_a_task;
    setup.script = ToolChanges(*options.frame_count, options.frame_rate_hz);
    setup.script.push_back({frames_a_task, SpacingRequest{kDemoGap, kGapNeededMm}});
    options.what_ends_it = "the simulated task, played twice";
  }
  setup.source = std::make_shared<recon::SyntheticRig>(
      recon::FourCameraRig(), [](double time_s) { return recon::DemoSceneAt(time_s).objects; }, options);
  return setup;
}

}  // namespace elbowroom::control
