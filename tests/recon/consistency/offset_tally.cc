#include "tests/recon/consistency/offset_tally.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace elbowroom::recon::testing {

void OffsetTally::Add(std::span<const double> found_s, std::span<const double> sigma_s,
                      const Eigen::MatrixXd& covariance_s2, std::span<const double> true_s) {
  Eigen::VectorXd off_s(static_cast<Eigen::Index>(true_s.size()) - 1);
  for (std::size_t i = 1; i < true_s.size(); ++i) {
    const double error_s = found_s[i] - true_s[i];
    off_s[static_cast<Eigen::Index>(i) - 1] = error_s;
    errors_s.push_back(std::abs(error_s));
    if (errors_s.back() < sigma_s[i]) ++within_1;
    if (errors_s.back() < 2.0 * sigma_s[i]) ++within_2;
  }
  squares += off_s.dot(covariance_s2.ldlt().solve(off_s));
}

void OffsetTally::Record(const std::string& name) const {
  const auto record = [&](const char* what, double value) {
    ::testing::Test::RecordProperty(name + what, static_cast<int>(std::lround(value)));
  };
  const auto count = static_cast<double>(errors_s.size());
  std::vector<double> sorted_s = errors_s;
  std::ranges::sort(sorted_s);
  record("_trials", count);
  record("_median_us", 1e6 * sorted_s[sorted_s.size() / 2]);
  record("_worst_us", 1e6 * sorted_s.back());
  record("_within_1_percent", 100.0 * within_1 / count);
  record("_within_2_percent", 100.0 * within_2 / count);
  record("_squares_percent", 100.0 * squares / count);
}

}  // namespace elbowroom::recon::testing
