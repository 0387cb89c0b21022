#include "recon/boards/seen_plane.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace elbowroom::recon {
namespace {

using Eigen::Vector2d;

constexpr std::size_t kLeastForBend = 12;
// Bends of lenses, from a strong fisheye's to a tele lens's pincushion.
constexpr double kLeastBend = -0.9, kMostBend = 0.3, kBendStep = 0.1;
constexpr int kRefinements = 12;
constexpr int kRounds = 4;
constexpr double kMedians = 5.0, kAlwaysFinePx = 0.5, kMostSquares = 0.2;

struct BentPlane {
  std::optional<SeenPlane> plane;
  double sum_px2 = std::numeric_limits<double>::infinity();
};

// The best homography for a given bend, and its squared errors in the picture.
BentPlane FitWithBend(const std::vector<PointPair>& pairs, double bend, const Vector2d& center,
                      double stretch) {
  std::vector<PointPair> undistorted = pairs;
  for (PointPair& pair : undistorted) {
    const Vector2d r = (pair.to - center) / stretch;
    pair.to = r / std::max(0.05, 1.0 + bend * r.squaredNorm());
  }
  const auto homography = FitHomography(undistorted);
  if (!homography) return {};
  BentPlane bent{SeenPlane(*homography, bend, center, stretch), 0.0};
  for (const PointPair& pair : pairs)
    bent.sum_px2 += (bent.plane->Project(pair.from) - pair.to).squaredNorm();
  if (!std::isfinite(bent.sum_px2)) bent.sum_px2 = std::numeric_limits<double>::infinity();
  return bent;
}

double Median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

Vector2d SeenPlane::Project(const Vector2d& x_in_board) const {
  const Vector2d undistorted = Map(undistorted_from_board_, x_in_board);
  // |u| = r / (1 + bend r^2) solved for r; the root that is |u| where bend is 0.
  const double under = 1.0 - 4.0 * bend_ * undistorted.squaredNorm();
  const double factor = 2.0 / (1.0 + std::sqrt(std::max(0.0, under)));
  return center_px_ + stretch_px_ * factor * undistorted;
}

Eigen::Matrix2d SeenPlane::PixelFromBoard(const Vector2d& x_in_board) const {
  constexpr double kStepMm = 1e-3;
  Eigen::Matrix2d derivative;
  for (int i = 0; i < 2; ++i) {
    const Vector2d step = kStepMm * Vector2d::Unit(i);
    derivative.col(i) = (Project(x_in_board + step) - Project(x_in_board - step)) / (2.0 * kStepMm);
  }
  return derivative;
}

std::optional<SeenPlane> FitSeenPlane(const std::vector<PointPair>& pairs, int width_px, int height_px) {
  const Vector2d center(0.5 * (width_px - 1), 0.5 * (height_px - 1));
  const double stretch = std::max(1.0, center.norm());
  const auto fit = [&](double bend) { return FitWithBend(pairs, bend, center, stretch); };
  BentPlane best = fit(0.0);
  if (pairs.size() < kLeastForBend) return best.plane;
  double best_bend = 0.0;
  const auto take_if_better = [&](double bend) {
    BentPlane bent = fit(bend);
    if (!(bent.sum_px2 < best.sum_px2)) return;
    best = std::move(bent);
    best_bend = bend;
  };
  for (double bend = kLeastBend; bend < kMostBend + 0.5 * kBendStep; bend += kBendStep) take_if_better(bend);
  double step = 0.5 * kBendStep;
  for (int i = 0; i < kRefinements; ++i, step *= 0.5) {
    const double middle = best_bend;
    take_if_better(middle - step);
    take_if_better(middle + step);
  }
  return best.plane;
}

std::vector<std::size_t> AgreeingPairs(const std::vector<PointPair>& pairs, double square_mm, int width_px,
                                       int height_px) {
  std::vector<std::size_t> kept(pairs.size());
  std::iota(kept.begin(), kept.end(), std::size_t{0});
  for (int round = 0; round < kRounds; ++round) {
    std::vector<PointPair> agreeing;
    for (const std::size_t i : kept) agreeing.push_back(pairs[i]);
    const std::optional<SeenPlane> plane = FitSeenPlane(agreeing, width_px, height_px);
    if (!plane) return {};
    std::vector<double> errors_px, limits_px;
    for (const PointPair& pair : agreeing) {
      errors_px.push_back((plane->Project(pair.from) - pair.to).norm());
      const double area = std::abs(plane->PixelFromBoard(pair.from).determinant());
      limits_px.push_back(kMostSquares * square_mm * std::sqrt(area));
    }
    const double usual_px = std::max(kMedians * Median(errors_px), kAlwaysFinePx);
    std::vector<std::size_t> next;
    for (std::size_t i = 0; i < kept.size(); ++i)
      if (errors_px[i] <= std::min(usual_px, limits_px[i])) next.push_back(kept[i]);
    if (next.size() == kept.size()) break;
    kept = std::move(next);
    if (kept.size() < 4) return {};
  }
  return kept;
}

}  // namespace elbowroom::recon
