#include "app/control/demo_trial.h"

#include <cmath>

#include "app/control/demo_parts.h"
#include "recon/synthetic/demo_motion.h"
#include "recon/synthetic/rig_presets.h"
#include "recon/synthetic/synthetic_rig.h"

namespace elbowroom::control {

TrialSetup MakeDemoTrial(DemoPlay play) {
  recon::SyntheticRigOptions options;
  const auto frames_a_task =
      static_cast<core::FrameIndex>(std::lround(recon::kTaskSeconds * options.frame_rate_hz));
  TrialSetup setup;
  setup.info = {.participant = "simulated hand",
                .task = "screw the pipe into the PMT box, then plug the power cable in with tongs",
                .estimate_mm = kGapInitialMm,
                .required_clearance_mm = 0.0,
                .tools = {"tongs"}};
  setup.layout = DemoLayout();
  if (play == DemoPlay::kOnce) {
    options.frame_count = 2 * frames_a_task;
    setup.script = {{frames_a_task, "payload_a_gap", kGapNeededMm}};
    setup.end_note = "ended with the simulated task, played twice";
  }
  setup.source = std::make_shared<recon::SyntheticRig>(
      recon::FourCameraRig(), [](double time_s) { return recon::DemoSceneAt(time_s).objects; }, options);
  return setup;
}

}  // namespace elbowroom::control
