// The bundle adjustment: all parameters of an Adjustment at once.
#pragma once

#include <optional>
#include <stop_token>

#include "recon/calibration/adjustment.h"
#include "recon/calibration/banded_schur.h"

namespace elbowroom::recon {

struct BundleOptions {
  // Residuals pass a Cauchy loss of this many times the noise scale; 0: plain least squares.
  double cauchy_scale = 0.0;
  double noise_scale = 1.0;  // s; what weak knowledge of the lens is weighed against
  int most_steps = 50;
  double settled = 1e-9;  // relative change of the cost in a step, below which the fit ends
};

// Levenberg and Marquardt's method; the sums over points run in parallel by views and are added in the order
// of views, so the result is the same for any number of threads. Throws: Error{kCancelled}.
[[nodiscard]] Adjustment AdjustBundle(Adjustment start, const BundleOptions& options,
                                      const std::stop_token& stop);

// Normal equations of the used points at the present parameters.
[[nodiscard]] NormalEquations EquationsOf(const Adjustment& adjustment, const BundleOptions& options);

// What one view, whose board no other view shows, says of its camera's lens: the normal equations of the
// intrinsics with the board's pose eliminated. Nothing: the view doesn't decide its pose.
struct LensEvidence {
  Eigen::MatrixXd information;
  Eigen::VectorXd gradient;
};
[[nodiscard]] std::optional<LensEvidence> LensEvidenceOf(const Adjustment& adjustment,
                                                         const AdjustedView& view);

// The sum over the used views of gᵀ C g / s⁴ with g the view's pull on the cameras once the boards are
// eliminated (minus the gradient of its half sum of squares) and C the covariance over s². With independent
// residuals it is about the number of the cameras' parameters.
[[nodiscard]] std::optional<double> SpreadOfPulls(const Adjustment& adjustment, double noise_scale);

// What a view says of its boards' poses if all else is known: information on the turn from the right and the
// translation of each, (rad, mm)^-2, for residuals over the sightings' standard deviations.
[[nodiscard]] Eigen::MatrixXd BoardInformation(const Adjustment& adjustment, const AdjustedView& view);

// Half the sum of losses that AdjustBundle lessens.
[[nodiscard]] double CostOf(const Adjustment& adjustment, const BundleOptions& options);

// The noise over the sightings' standard deviations. Robust: from the median of the used points' residuals,
// as if they were normal in both coordinates. Else from their sum of squares and the degrees of freedom;
// nothing where there are none.
[[nodiscard]] double RobustNoiseScale(const Adjustment& adjustment);
[[nodiscard]] std::optional<double> NoiseScale(const Adjustment& adjustment);

}  // namespace elbowroom::recon
