// The paper's payload task, scripted: a hand brings a pipe, stands it up and lowers it into the receptacle;
// then, with tongs, it feeds a power cable down the pipe, stroke by stroke, to the outlet.
#pragma once

#include <Eigen/Core>
#include <string_view>
#include <vector>

#include "core/units.h"
#include "recon/synthetic/solids.h"

namespace elbowroom::recon {

inline constexpr double kTaskSeconds = 16.0;
inline constexpr double kCableBeginsS = 8.2;  // the hand has left the pipe, and fetches cable and tongs

enum class DemoPhase { kBringPipe, kLowerPipe, kLeavePipe, kBringCable, kFeedCable, kLeaveCable };

[[nodiscard]] std::string_view ToString(DemoPhase phase);  // "bring the pipe", ...

struct DemoScene {
  std::vector<SyntheticObject> objects;  // world: the receptacle's axis is the z axis, the table top z = 0
  DemoPhase phase = DemoPhase::kBringPipe;
  bool tongs_in_use = false;
};

// How a person does it. As it stands: the demo's.
struct PayloadManner {
  double hand_size = 1.0;          // HandBuild::size; [0.8, 1.2]
  double from_rad = 0.0;           // where the person stands, about the receptacle's axis from the x axis
  Eigen::Vector2d aside_mm{0, 0};  // where the pipe is put, from the receptacle's axis; at most 10 mm
  double lift_mm = 0.0;            // higher than need be: the pipe, until it is lowered; [0, 100]
  double rise_mm = 52.0;           // of the hand, off the pipe that is in
  bool takes_tongs = true;         // else the bare hand feeds the cable
  double tongs_elevation_rad = core::RadiansFromDegrees(30.0);  // how steeply they are held; [0, 80 degrees]
  double tongs_grip_mm = 135.0;                                 // from their tips
  int strokes = 4;                                              // that feed the cable; > 0

  // Throws: PreconditionError naming the field out of range.
  void Validate() const;
};

// The scene at a time of the task, 0 to kTaskSeconds; `manner` is valid.
[[nodiscard]] DemoScene PayloadSceneAt(const PayloadManner& manner, double task_time_s);

// The scene at a time from the task's begin; the task repeats every kTaskSeconds, each time from an empty
// receptacle. Nothing real ever passes through the demo's PMT box (docs/demo_parts.md). Throws:
// PreconditionError for a negative time.
[[nodiscard]] DemoScene DemoSceneAt(double time_s);

// Where pipe and plug come to rest, for placing parts around the motion.
inline constexpr double kPipeStandsAtZMm = 65.0;  // lower end of the pipe when it is in
inline constexpr double kPlugEndsAtZMm = 49.0;    // front face of the plug when the cable is in

}  // namespace elbowroom::recon
