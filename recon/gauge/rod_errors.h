// How errors of boundaries and of the calibration arrive in a figure that is linear in the sights' errors.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/rig.h"
#include "recon/gauge/cylinder.h"

namespace elbowroom::recon {

class RodErrors {
 public:
  // All three outlive it; `limits_mm` is how far off each sight may be. Throws: PreconditionError for a
  // covariance of another size than the rig's.
  RodErrors(const core::Rig& rig, const Eigen::MatrixXd& covariance, std::span<const TangentSight> sights,
            std::span<const Touch> touches, std::span<const double> limits_mm);

  // The most that boundaries within their limits can do to the figure with these weights of the sights.
  [[nodiscard]] double WorstMm(const Eigen::VectorXd& weights) const;
  // The derivative of the figure by all parameters; empty without a covariance.
  [[nodiscard]] Eigen::VectorXd ByParameters(const Eigen::VectorXd& weights) const;
  // kGaugeSigmas standard deviations of a figure with that derivative.
  [[nodiscard]] double CalibrationMm(const Eigen::VectorXd& by_parameters) const;
  // The same for a derivative by one camera's parameters, spread over all.
  [[nodiscard]] Eigen::VectorXd OfCamera(int camera, const Eigen::VectorXd& by_its_parameters) const;

 private:
  const Eigen::MatrixXd& covariance_;
  std::span<const TangentSight> sights_;
  std::span<const double> limits_mm_;
  std::vector<int> first_;                      // parameter of each camera
  std::vector<Eigen::VectorXd> by_parameters_;  // of each sight's error, by its camera's
};

}  // namespace elbowroom::recon
