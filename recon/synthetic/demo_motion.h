// The paper's payload task, scripted: a hand brings a pipe, stands it up and lowers it into the receptacle;
// then, with tongs, it feeds a power cable down the pipe, stroke by stroke, to the outlet.
#pragma once

#include <string_view>
#include <vector>

#include "recon/synthetic/solids.h"

namespace elbowroom::recon {

inline constexpr double kTaskSeconds = 16.0;

enum class DemoPhase { kBringPipe, kLowerPipe, kLeavePipe, kBringCable, kFeedCable, kLeaveCable };

[[nodiscard]] std::string_view ToString(DemoPhase phase);  // "bring the pipe", ...

struct DemoScene {
  std::vector<SyntheticObject> objects;  // world: the receptacle's axis is the z axis, the table top z = 0
  DemoPhase phase = DemoPhase::kBringPipe;
  bool tongs_in_use = false;
};

// The scene at a time from the task's begin; the task repeats every kTaskSeconds, each time from an empty
// receptacle. Nothing real ever passes through the demo's PMT box (docs/demo_parts.md). Throws:
// PreconditionError for a negative time.
[[nodiscard]] DemoScene DemoSceneAt(double time_s);

// Where pipe and plug come to rest, for placing parts around the motion.
inline constexpr double kPipeStandsAtZMm = 65.0;  // lower end of the pipe when it is in
inline constexpr double kPlugEndsAtZMm = 49.0;    // front face of the plug when the cable is in

}  // namespace elbowroom::recon
