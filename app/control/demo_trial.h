// The embedded default: the paper's payload task, simulated.
#pragma once

#include "app/control/trial_setup.h"

namespace elbowroom::control {

enum class DemoPlay {
  kOnce,     // the task at 140 mm, then, the gap opened live to 240 mm, again: for `demo --headless`
  kForever,  // the task over and over; the experimenter moves the gap: for the console
};

// Four simulated 640 x 480 cameras, the PMT box and payloads A and B (docs/demo_parts.md).
[[nodiscard]] TrialSetup MakeDemoTrial(DemoPlay play);

}  // namespace elbowroom::control
