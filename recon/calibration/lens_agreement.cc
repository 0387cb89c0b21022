#include "recon/calibration/lens_agreement.h"

#include <tbb/parallel_for.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "recon/calibration/bundle.h"

namespace elbowroom::recon {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kSigmas = 5.0;

// A view's pull on the lens as chi squared, and its degrees of freedom.
struct Pull {
  double chi2 = 0.0;
  int freedom = 0;
};

Pull PullOf(const LensEvidence& evidence, const MatrixXd& covariance, double noise_scale) {
  constexpr double kLeastShare = 1e-3;  // of the whole knowledge
  const double variance = noise_scale * noise_scale;
  const VectorXd sigma = covariance.diagonal().cwiseSqrt();
  const MatrixXd information = sigma.asDiagonal() * (evidence.information / variance) * sigma.asDiagonal();
  const MatrixXd correlation =
      sigma.cwiseInverse().asDiagonal() * covariance * sigma.cwiseInverse().asDiagonal();
  const VectorXd gradient = sigma.asDiagonal() * (evidence.gradient / variance);
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(information - information * correlation * information);
  Pull pull;
  for (Eigen::Index i = 0; i < gradient.size(); ++i) {
    const double known = solver.eigenvalues()[i];
    if (known < kLeastShare) continue;
    pull.chi2 += std::pow(solver.eigenvectors().col(i).dot(gradient), 2) / known;
    ++pull.freedom;
  }
  return pull;
}

// By Wilson and Hilferty the cube root of chi squared over its degrees of freedom is normal.
double SigmasOfPull(const Pull& pull, double usual) {
  const double part = 2.0 / (9.0 * pull.freedom);
  return (std::cbrt(pull.chi2 / pull.freedom / usual) - 1.0 + part) / std::sqrt(part);
}

double UsualPull(std::vector<double> per_freedom) {
  if (per_freedom.empty()) return 1.0;
  const auto middle = per_freedom.begin() + static_cast<std::ptrdiff_t>(per_freedom.size() / 2);
  std::nth_element(per_freedom.begin(), middle, per_freedom.end());
  return std::max(1.0, *middle);
}

}  // namespace

std::vector<std::size_t> ContradictingViews(const Adjustment& a, const std::vector<bool>& is_alone,
                                            const MatrixXd& covariance, double noise_scale) {
  std::vector<Pull> pulls(a.views.size());
  tbb::parallel_for(std::size_t{0}, a.views.size(), [&](std::size_t i) {
    const AdjustedView& view = a.views[i];
    if (!view.is_used || !is_alone[i] || a.cameras[static_cast<std::size_t>(view.camera)].is_lens_fixed)
      return;
    const ParameterBlock block = a.BlockOf(view.camera);
    const auto evidence = LensEvidenceOf(a, view);
    if (evidence)
      pulls[i] =
          PullOf(*evidence, covariance.block(block.first, block.first, block.intrinsics, block.intrinsics),
                 noise_scale);
  });
  std::vector<std::size_t> contradicting;
  for (int camera = 0; camera < static_cast<int>(a.cameras.size()); ++camera) {
    std::vector<double> per_freedom;
    double worst = 0.0;
    for (std::size_t i = 0; i < pulls.size(); ++i) {
      if (a.views[i].camera != camera || pulls[i].freedom == 0) continue;
      per_freedom.push_back(pulls[i].chi2 / pulls[i].freedom);
      worst = std::max(worst, pulls[i].chi2);
    }
    const double usual = UsualPull(per_freedom);
    for (std::size_t i = 0; i < pulls.size(); ++i)
      if (a.views[i].camera == camera && pulls[i].freedom > 0 && pulls[i].chi2 >= 0.5 * worst &&
          SigmasOfPull(pulls[i], usual) > kSigmas)
        contradicting.push_back(i);
  }
  return contradicting;
}

}  // namespace elbowroom::recon
