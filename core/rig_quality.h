// How exact a rig is: what its calibration says, and what its gauge found.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

namespace elbowroom::core {

// How far a boundary that is located between pixels is off, in px, 1 sigma: the crowded moment of
// docs/segmentation.md has 0.19.
inline constexpr double kBoundarySigmaPx = 0.2;

// What a distance's uncertainty is computed from.
struct RigErrors {
  // Of all cameras' parameters: for each camera fx fy cx cy [px], its distortion coefficients, rotation
  // [rad], translation [mm], time offset [s].
  Eigen::MatrixXd covariance;
  double boundary_sigma_px = kBoundarySigmaPx;

  // Throws: Error{kRange} for a boundary's error that isn't 0 or more and finite.
  void Validate() const;
};

// What the last gauge said: a rod of known diameter, measured through the workspace (docs/gauge.md).
struct RigGauge {
  std::string made;  // when, UTC
  double true_diameter_mm = 0.0;
  double diameter_mm = 0.0;  // of the place with the largest error, as the next two
  double error_mm = 0.0;     // measured less true
  double bound_mm = 0.0;
  int places = 0;
  bool passed = false;  // every place is within its bound

  [[nodiscard]] bool operator==(const RigGauge&) const = default;
};

struct RigQuality {
  std::optional<RigErrors> errors;  // nothing: verdicts allow for what the trial says
  std::optional<RigGauge> gauge;    // nothing: none was measured

  [[nodiscard]] bool is_refuted() const { return gauge && !gauge->passed; }
};

}  // namespace elbowroom::core
