#include "recon/gauge/rod_errors.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/error.h"
#include "recon/calibration/calibration_result.h"
#include "recon/calibration/lens_projection.h"
#include "recon/gauge/rod_gauge.h"

namespace elbowroom::recon {

RodErrors::RodErrors(const core::Rig& rig, const Eigen::MatrixXd& covariance,
                     std::span<const TangentSight> sights, std::span<const Touch> touches,
                     std::span<const double> limits_mm)
    : covariance_(covariance), sights_(sights), limits_mm_(limits_mm) {
  if (covariance.size() == 0) return;
  int parameters = 0;
  for (const core::CameraModel& camera : rig.cameras) {
    first_.push_back(parameters);
    parameters += ParameterBlock{0, LensParametersOf(camera.calibration()).count()}.size();
  }
  core::Require(covariance.rows() == parameters && covariance.cols() == parameters,
                "the covariance has a row for each parameter of the cameras");
  for (std::size_t i = 0; i < sights.size(); ++i)
    by_parameters_.push_back(ErrorByParameters(touches[i], sights[i]));
}

double RodErrors::WorstMm(const Eigen::VectorXd& weights) const {
  double worst_mm = 0.0;
  for (std::size_t i = 0; i < limits_mm_.size(); ++i)
    worst_mm += std::abs(weights[static_cast<Eigen::Index>(i)]) * limits_mm_[i];
  return worst_mm;
}

Eigen::VectorXd RodErrors::ByParameters(const Eigen::VectorXd& weights) const {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(covariance_.rows());
  for (std::size_t i = 0; i < by_parameters_.size(); ++i) {
    const auto camera = static_cast<std::size_t>(sights_[i].camera);
    sum.segment(first_[camera], by_parameters_[i].size()) +=
        weights[static_cast<Eigen::Index>(i)] * by_parameters_[i];
  }
  return sum;
}

double RodErrors::CalibrationMm(const Eigen::VectorXd& by_parameters) const {
  if (covariance_.size() == 0) return 0.0;
  return kGaugeSigmas * std::sqrt(std::max(0.0, by_parameters.dot(covariance_ * by_parameters)));
}

Eigen::VectorXd RodErrors::OfCamera(int camera, const Eigen::VectorXd& by_its_parameters) const {
  Eigen::VectorXd all = Eigen::VectorXd::Zero(covariance_.rows());
  if (covariance_.size() > 0)
    all.segment(first_[static_cast<std::size_t>(camera)], by_its_parameters.size()) = by_its_parameters;
  return all;
}

}  // namespace elbowroom::recon
