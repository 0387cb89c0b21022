// A made-up trial of the pipe-and-cable task, for the report's tests.
#pragma once

#include <filesystem>
#include <vector>

namespace elbowroom::tests {

struct TouchPlan {
  int part = 0;
  double begin_s = 0.0;
  double end_s = 0.0;
  double depth_mm = 0.0;  // at its middle
};

// What happens in a trial of `duration_s` at 10 frames a second: the spacing starts at 140 mm and is opened
// in steps of 20 mm, one each 0.1 s, to 240 mm at `opened_at_s`; the tongs are in use from 20 s to 50 s.
struct TrialPlan {
  double duration_s = 62.0;
  double opened_at_s = 35.0;  // beyond the duration: never
  double estimate_mm = 140.0;
  std::vector<TouchPlan> touches;
  bool is_finished = true;
};

// Seven touches of payload A and the PMT box at 140 mm, none at 240 mm.
[[nodiscard]] TrialPlan UsualTrial();

void WriteTrial(const std::filesystem::path& path, const TrialPlan& plan);

}  // namespace elbowroom::tests
