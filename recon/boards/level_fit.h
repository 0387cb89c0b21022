// Least squares for a small model of the grey levels around one place, with the covariance of its parameters.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <optional>
#include <vector>

namespace elbowroom::recon {

// One pixel of a window.
struct LevelSample {
  Eigen::Vector2d offset_px;  // from the window's origin
  double level = 0.0;         // grey level, 0 to 255
};

template <int N>
struct LevelFit {
  Eigen::Matrix<double, N, 1> parameters;
  Eigen::Matrix<double, N, N> covariance;  // (J^T J)^-1 times the residuals' variance
  double sum_of_squares = 0.0;             // of the residuals, in grey levels^2
};

// The parameters that give the least sum of squares, from `start` by Levenberg-Marquardt. `model(x, offset,
// &gradient)` returns the level at an offset and its derivatives; `hold(&x)` puts parameters back into their
// range after each step. Nothing: fewer samples than N + 2, or a parameter that the levels don't determine.
template <int N, typename Model, typename Hold>
[[nodiscard]] std::optional<LevelFit<N>> FitLevels(const std::vector<LevelSample>& samples,
                                                   const Eigen::Matrix<double, N, 1>& start,
                                                   const Model& model, const Hold& hold) {
  using Vector = Eigen::Matrix<double, N, 1>;
  using Square = Eigen::Matrix<double, N, N>;
  constexpr int kMostSteps = 25;
  constexpr double kSmallestStep = 1e-4, kLargestDamping = 1e6;
  if (samples.size() < static_cast<std::size_t>(N) + 2) return std::nullopt;
  Square normal;
  Vector right;
  const auto linearise = [&](const Vector& x) {
    double sum = 0.0;
    Vector gradient;
    normal.setZero();
    right.setZero();
    for (const LevelSample& sample : samples) {
      const double residual = sample.level - model(x, sample.offset_px, &gradient);
      normal.template selfadjointView<Eigen::Lower>().rankUpdate(gradient);
      right += residual * gradient;
      sum += residual * residual;
    }
    return sum;
  };
  Vector x = start;
  double sum = linearise(x);
  Square best_normal = normal;
  Vector best_right = right;
  double damping = 1e-2;
  for (int step = 0; step < kMostSteps && damping < kLargestDamping; ++step) {
    Square damped = best_normal;
    damped.diagonal() *= 1.0 + damping;
    const Vector change = damped.template selfadjointView<Eigen::Lower>().ldlt().solve(best_right);
    if (!change.allFinite()) return std::nullopt;
    Vector next = x + change;
    hold(&next);
    const double next_sum = linearise(next);
    if (!(next_sum < sum)) {
      damping *= 10.0;
      continue;
    }
    const bool is_done = (next - x).norm() < kSmallestStep || sum - next_sum < 1e-5 * sum;
    x = next;
    sum = next_sum;
    best_normal = normal;
    best_right = right;
    damping = std::max(1e-6, 0.1 * damping);
    if (is_done) break;
  }
  const Square full = best_normal.template selfadjointView<Eigen::Lower>();
  const Eigen::LDLT<Square> factors(full);
  if (factors.info() != Eigen::Success || !(factors.vectorD().minCoeff() > 0.0)) return std::nullopt;
  const double variance = sum / static_cast<double>(samples.size() - N);
  return LevelFit<N>{x, variance * factors.solve(Square::Identity()), sum};
}

}  // namespace elbowroom::recon
