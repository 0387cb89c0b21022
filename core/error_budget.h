// What a verdict on clearance allows for, and what that is made of.
#pragma once

namespace elbowroom::core {

// A distance is off by more than this many standard uncertainties in 5 % of cases.
inline constexpr double kCoverageFactor = 2.0;

// Standard uncertainties (1 sigma), in mm, of the distance from a part to the hull (docs/error_budget.md).
struct ErrorBudget {
  double calibration_mm = 0.0;   // of the cameras' parameters
  double footprint_mm = 0.0;     // a ready mask's boundary lies anywhere between two pixels
  double segmentation_mm = 0.0;  // noise of a boundary that is located between pixels
  double skew_mm = 0.0;          // of cameras that don't look at one instant; 0 where they have no stamps
  // Half of what the trial says is allowed for. Then the first three are 0: they are in it.
  double given_mm = 0.0;

  [[nodiscard]] double CombinedMm() const;  // the root of the sum of their squares
  [[nodiscard]] double ExpandedMm() const { return kCoverageFactor * CombinedMm(); }
  [[nodiscard]] bool operator==(const ErrorBudget&) const = default;
};

}  // namespace elbowroom::core
