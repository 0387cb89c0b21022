#include "recon/calibration/outliers.h"

#include <algorithm>
#include <cmath>

namespace elbowroom::recon {
namespace {

// Residual over standard deviation of each point of a view.
std::vector<double> SigmasOf(const Adjustment& a, const AdjustedView& view) {
  constexpr double kBehind = 1e4;
  const core::RigidTransform cam_from_board = CamFromBoardAt(a, view);
  std::vector<double> sigmas;
  for (const AdjustedPoint& point : view.points) {
    const auto residual = ResidualOf(a, view, cam_from_board, point);
    sigmas.push_back(residual ? residual->norm() * point.inverse_sigma : kBehind);
  }
  return sigmas;
}

// Of the points within `most`: a few wrong points don't make a wrong view.
double RootMeanSquare(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value * value;
  return values.empty() ? 0.0 : std::sqrt(sum / static_cast<double>(values.size()));
}

double MedianOf(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

bool LeavePoints(const std::vector<double>& sigmas, double limit, AdjustedView* view) {
  bool has_changed = false;
  for (std::size_t i = 0; i < view->points.size(); ++i) {
    const bool is_used = sigmas[i] <= limit;
    has_changed |= is_used != view->points[i].is_used;
    view->points[i].is_used = is_used;
  }
  return has_changed;
}

double KeptError(const std::vector<double>& sigmas, const AdjustedView& view) {
  std::vector<double> kept;
  for (std::size_t i = 0; i < sigmas.size(); ++i)
    if (view.points[i].is_used) kept.push_back(sigmas[i]);
  return RootMeanSquare(kept);
}

}  // namespace

std::vector<double> ViewMedians(const Adjustment& a) {
  std::vector<double> medians;
  for (const AdjustedView& view : a.views) medians.push_back(MedianOf(SigmasOf(a, view)));
  return medians;
}

bool LeaveOutliers(double noise_scale, Adjustment* a) {
  bool has_changed = false;
  std::vector<std::vector<double>> kept_errors(a->cameras.size());
  std::vector<double> errors(a->views.size(), 0.0);
  for (std::size_t i = 0; i < a->views.size(); ++i) {
    AdjustedView& view = a->views[i];
    if (!view.is_used) continue;
    const std::vector<double> sigmas = SigmasOf(*a, view);
    has_changed |= LeavePoints(sigmas, kPointSigmas * noise_scale, &view);
    errors[i] = KeptError(sigmas, view);
    kept_errors[static_cast<std::size_t>(view.camera)].push_back(errors[i]);
  }
  std::vector<double> medians;
  for (const std::vector<double>& kept : kept_errors) medians.push_back(MedianOf(kept));
  for (std::size_t i = 0; i < a->views.size(); ++i) {
    AdjustedView& view = a->views[i];
    if (!view.is_used) continue;
    const auto kept = static_cast<std::size_t>(std::ranges::count_if(view.points, &AdjustedPoint::is_used));
    if (kept >= 4 && 2 * kept >= view.points.size() &&
        errors[i] <= kViewMedians * medians[static_cast<std::size_t>(view.camera)])
      continue;
    view.is_used = false;
    has_changed = true;
  }
  return has_changed;
}

}  // namespace elbowroom::recon
