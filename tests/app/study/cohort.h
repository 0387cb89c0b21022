// Simulated participants who reach below a lid, of whom it is known how much space they need.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace elbowroom::tests {

// One session. Heights above the floor, mm.
struct Reach {
  std::string participant;
  std::string condition;
  int order = 0;
  double estimate_before_mm = 0.0;  // 0: none
  double estimate_after_mm = 0.0;   // 0: none
  double hand_mm = 60.0;            // the highest that the bare hand gets
  double tool_mm = 0.0;             // the highest with a tool in the hand; 0: no tool
  double step_s = 0.5;              // how long the step "reach in" takes
  int presence = 0;                 // the answer to "presence", 1 to 7; 0: none
  double lid_mm = 250.0;            // where the lid is in the trial; below what is reached it is touched
  int sickness = -1;                // the answer to "sickness: nausea", worth 0 to 3; below 0: not asked
  std::string block = {};           // of the study
};

// What the silhouettes show: the highest point of the hull above the floor, mm.
struct Seen {
  double hand_mm = 0.0;
  double tool_mm = 0.0;  // with it and the hand
};

// Six frames, from exact masks of eight cameras; the gap is called "lid_gap" and may
// be 20 to 300 mm. The tool is in use from the fourth frame on.
void RecordReach(const std::filesystem::path& path, const Reach& reach);

// Sought by point queries alone, each quarter of a millimetre along verticals 2.5 mm apart.
[[nodiscard]] Seen SeenOf(const Reach& reach);

}  // namespace elbowroom::tests
