// Sessions to be reviewed by tests.
#pragma once

#include <filesystem>

#include "app/control/trial_runner.h"
#include "app/control/trial_setup.h"

namespace elbowroom::control {

// Part of the demo: the hand meets the payload.
void RecordDemo(const std::filesystem::path& session, FrameRange frames);
void RecordDemo(const std::filesystem::path& session, FrameRange frames, const TrialSetup& setup);

inline constexpr FrameRange kWithTouches = {40, 130};

// The demo's hand amid other shapes: needles on the table, a ball on the gap "ball_gap" (z) above them, and a
// scanned wall on "wall_gap" (x) beside them. The ball moves in the middle. The cameras have stamps that
// differ, frame 66 lacks a camera, and frames 70 to 73 are equal.
void RecordOtherShapes(const std::filesystem::path& session);

}  // namespace elbowroom::control
