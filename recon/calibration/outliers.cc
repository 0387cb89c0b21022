#include "recon/calibration/outliers.h"

#include <Eigen/Eigenvalues>
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

// Points on one line don't tell how the board is turned about it.
bool AreOnALine(const Adjustment& a, const AdjustedView& view) {
  constexpr double kThin = 1e-6;  // of the points' variance across the line over that along it
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  Eigen::Matrix2d squares = Eigen::Matrix2d::Zero();
  double count = 0.0;
  for (const AdjustedPoint& point : view.points) {
    if (!point.is_used) continue;
    const Eigen::Vector2d at = a.surface->Flat(point.point).head<2>();
    sum += at;
    squares += at * at.transpose();
    count += 1.0;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> spread(squares - sum * sum.transpose() / count);
  return spread.eigenvalues()[0] <= kThin * spread.eigenvalues()[1];
}

// How far a view is off, measured by its camera's other views.
struct ViewMisfit {
  int points = 0;
  double rms = 0.0;     // of the used points, over their standard deviations
  double excess = 0.0;  // standard deviations above the camera's median
  bool is_too_large = false;
};

void MeasureAgainstCamera(int camera, const Adjustment& a, std::vector<ViewMisfit>* misfits) {
  std::vector<double> errors;
  std::vector<std::size_t> views;
  for (std::size_t i = 0; i < a.views.size(); ++i) {
    if (!a.views[i].is_used || a.views[i].camera != camera) continue;
    views.push_back(i);
    errors.push_back((*misfits)[i].rms);
  }
  const double median = std::max(MedianOf(errors), 1e-9);
  std::vector<double> sizes;
  for (const std::size_t i : views) {
    ViewMisfit& misfit = (*misfits)[i];
    misfit.excess = (misfit.rms / median - 1.0) * std::sqrt(4.0 * misfit.points);
    sizes.push_back(std::abs(misfit.excess));
  }
  constexpr double kSigmaOfMedian = 1.4826;  // of a normal distribution, over its median deviation
  const double spread = std::max(1.0, kSigmaOfMedian * MedianOf(sizes));
  for (const std::size_t i : views)
    (*misfits)[i].is_too_large =
        (*misfits)[i].excess > kViewSigmas * spread || (*misfits)[i].rms > kViewMedians * median;
}

}  // namespace

std::vector<double> ViewMedians(const Adjustment& a) {
  std::vector<double> medians;
  for (const AdjustedView& view : a.views) medians.push_back(MedianOf(SigmasOf(a, view)));
  return medians;
}

bool LeaveOutliers(double noise_scale, Adjustment* a) {
  bool has_changed = false;
  std::vector<ViewMisfit> misfits(a->views.size());
  for (std::size_t i = 0; i < a->views.size(); ++i) {
    AdjustedView& view = a->views[i];
    if (!view.is_used) continue;
    const std::vector<double> sigmas = SigmasOf(*a, view);
    has_changed |= LeavePoints(sigmas, kPointSigmas * noise_scale, &view);
    misfits[i].points = static_cast<int>(std::ranges::count_if(view.points, &AdjustedPoint::is_used));
    misfits[i].rms = KeptError(sigmas, view);
  }
  for (std::size_t camera = 0; camera < a->cameras.size(); ++camera)
    MeasureAgainstCamera(static_cast<int>(camera), *a, &misfits);
  std::vector<double> worst_of_board(a->boards.size(), 0.0);
  for (std::size_t i = 0; i < a->views.size(); ++i)
    for (int b = 0; b < a->views[i].board_count; ++b) {
      double& worst =
          worst_of_board[static_cast<std::size_t>(a->views[i].boards[static_cast<std::size_t>(b)])];
      if (a->views[i].is_used) worst = std::max(worst, misfits[i].excess);
    }
  for (std::size_t i = 0; i < a->views.size(); ++i) {
    AdjustedView& view = a->views[i];
    if (!view.is_used) continue;
    bool is_worst = true;
    for (int b = 0; b < view.board_count; ++b)
      is_worst &= misfits[i].excess >=
                  worst_of_board[static_cast<std::size_t>(view.boards[static_cast<std::size_t>(b)])];
    const bool has_too_few = misfits[i].points < 4 ||
                             2 * static_cast<std::size_t>(misfits[i].points) < view.points.size() ||
                             AreOnALine(*a, view);
    if (!has_too_few && !(is_worst && misfits[i].is_too_large)) continue;
    view.is_used = false;
    has_changed = true;
  }
  return has_changed;
}

}  // namespace elbowroom::recon
