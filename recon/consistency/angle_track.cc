#include "recon/consistency/angle_track.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "core/error.h"

namespace elbowroom::recon {
namespace {

constexpr double kReachPeriods = 3.5;
constexpr std::ptrdiff_t kFewestSamples = 6, kFewestOfASide = 2;

}  // namespace

AngleTrack::AngleTrack(std::vector<AngleSample> samples) : samples_(std::move(samples)) {
  std::vector<double> steps_s;
  for (std::size_t i = 1; i < samples_.size(); ++i) {
    steps_s.push_back(samples_[i].stamp_s - samples_[i - 1].stamp_s);
    core::Require(steps_s.back() > 0.0, "a track's stamps ascend");
  }
  if (steps_s.empty()) return;
  const auto middle = steps_s.begin() + static_cast<std::ptrdiff_t>(steps_s.size() / 2);
  std::nth_element(steps_s.begin(), middle, steps_s.end());
  period_s_ = *middle;
}

std::optional<AngleAtTime> AngleTrack::At(double stamp_s) const {
  const double reach_s = kReachPeriods * period_s_;
  const auto first = std::ranges::lower_bound(samples_, stamp_s - reach_s, {}, &AngleSample::stamp_s);
  const auto end =
      std::ranges::upper_bound(first, samples_.end(), stamp_s + reach_s, {}, &AngleSample::stamp_s);
  const auto before = std::ranges::count_if(first, end, [&](const auto& s) { return s.stamp_s <= stamp_s; });
  if (end - first < kFewestSamples || before < kFewestOfASide || end - first - before < kFewestOfASide) {
    return std::nullopt;
  }
  // angle = c0 + c1 u + c2 u^2 with u = (stamp - stamp_s) / reach, by weighted least squares.
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  const auto basis_at = [&](const AngleSample& sample) {
    const double u = (sample.stamp_s - stamp_s) / reach_s;
    return Eigen::Vector3d(1.0, u, u * u);
  };
  const auto weight_of = [](const Eigen::Vector3d& basis) {
    return std::pow(1.0 - std::pow(std::abs(basis[1]), 3), 3);
  };
  for (auto sample = first; sample != end; ++sample) {
    const Eigen::Vector3d basis = basis_at(*sample);
    normal += weight_of(basis) * basis * basis.transpose();
  }
  const Eigen::Matrix3d inverse = normal.inverse();
  AngleAtTime at;
  for (auto sample = first; sample != end; ++sample) {
    const Eigen::Vector3d basis = basis_at(*sample);
    const Eigen::Vector3d share = inverse * basis * weight_of(basis);
    at.angle_rad += share[0] * sample->tangent.angle_rad;
    at.rate_rad_s += share[1] / reach_s * sample->tangent.angle_rad;
  }
  const auto after = first + before;
  at.nearest =
      stamp_s - (after - 1)->stamp_s < after->stamp_s - stamp_s ? &(after - 1)->tangent : &after->tangent;
  return at;
}

}  // namespace elbowroom::recon
