// How far many time offsets that were found are off, and whether their sigmas hold.
#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

namespace elbowroom::recon::testing {

struct OffsetTally {
  std::vector<double> errors_s;  // of each camera but the first, absolute
  int within_1 = 0, within_2 = 0;
  double squares = 0.0;  // of the errors in sigmas, by the covariance; one for each error is right

  // `true_s` by camera; that of the first is 0.
  void Add(std::span<const double> found_s, std::span<const double> sigma_s,
           const Eigen::MatrixXd& covariance_s2, std::span<const double> true_s);
  // As properties of the test that runs, in the report of the test program.
  void Record(const std::string& name) const;
};

}  // namespace elbowroom::recon::testing
