#include "recon/calibration/uncertainty_scale.h"

#include <cmath>
#include <optional>
#include <random>

#include "recon/calibration/bundle.h"

namespace elbowroom::recon {
namespace {

// The rig with the pictures that the fit predicts, and independent noise of their points.
RigState WithDrawnNoise(const RigFit& fit) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  RigState drawn = fit.state;
  for (RigView& view : drawn.views) {
    if (view.adjusted < 0) continue;
    const AdjustedView& adjusted = fit.adjustment.views[static_cast<std::size_t>(view.adjusted)];
    const core::RigidTransform cam_from_board = CamFromBoardAt(fit.adjustment, adjusted);
    for (AdjustedPoint& point : view.points) {
      const double sigma_px = fit.noise_scale / point.inverse_sigma;
      const double x = sigma_px * normal(random), y = sigma_px * normal(random);
      const auto residual = ResidualOf(fit.adjustment, adjusted, cam_from_board, point);
      if (residual) point.pixel += *residual + Eigen::Vector2d(x, y);
    }
  }
  return drawn;
}

}  // namespace

double UncertaintyScale(const RigFit& fit, const std::stop_token& stop) {
  constexpr int kSteps = 8;
  constexpr double kByChance = 1.25;  // independent noise gives less (CalibrationCoverage)
  RigState drawn = WithDrawnNoise(fit);
  const Adjustment refitted = FitPlainly(&drawn, fit.noise_scale, kSteps, stop);
  const std::optional<double> spread = SpreadOfPulls(fit.adjustment, fit.noise_scale),
                              independent = SpreadOfPulls(refitted, fit.noise_scale);
  if (!spread || !independent || *independent <= 0.0) return 1.0;
  const double scale = std::sqrt(*spread / *independent);
  return scale > kByChance ? scale : 1.0;
}

}  // namespace elbowroom::recon
