#include "recon/boards/circle_blobs.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>

namespace elbowroom::recon {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;

constexpr double kLeastAreaPx2 = 20.0;
constexpr double kMostAreaShare = 0.1;  // of the picture
constexpr double kMostAxisRatio = 10.0;
constexpr double kMostRimSpread = 0.06;  // of the rim's distance from the centre, as a share of the radius
constexpr double kOutlineErrorPx = 0.4;  // of an outline that runs through pixel centres
constexpr double kDarkerByLevels = 6.0;
constexpr double kLeastCircleContrast = 12.0;
constexpr double kLeastCenterSigmaPx = 0.01;
// Shares of the radius: inside, all is dark; outside, all is light up to the window's end.
constexpr double kInside = 0.6, kOutside = 1.2, kWindow = 1.4;

// The ellipse that has an outline's moments, if the outline is one.
std::optional<CircleBlob> EllipseOf(const std::vector<cv::Point>& outline, double most_area_px2) {
  const cv::Moments m = cv::moments(outline);
  if (m.m00 < kLeastAreaPx2 || m.m00 > most_area_px2) return std::nullopt;
  const Vector2d center(m.m10 / m.m00, m.m01 / m.m00);
  Matrix2d spread;
  spread << m.mu20, m.mu11, m.mu11, m.mu02;
  spread *= 4.0 / m.m00;  // the rim is x^T spread^-1 x = 1
  const Eigen::SelfAdjointEigenSolver<Matrix2d> solver(spread);
  const Vector2d axes = solver.eigenvalues().cwiseMax(0.0).cwiseSqrt();
  if (!(axes[0] > 1.0 && axes[1] <= kMostAxisRatio * axes[0])) return std::nullopt;
  const double area_ratio = m.m00 / (std::numbers::pi * axes[0] * axes[1]);
  if (!(std::abs(area_ratio - 1.0) < 0.1)) return std::nullopt;
  const Matrix2d unit_from_pixel = solver.operatorInverseSqrt();
  double sum = 0.0, squares = 0.0;
  for (const cv::Point& point : outline) {
    const double radius = (unit_from_pixel * (Vector2d(point.x, point.y) - center)).norm();
    sum += radius;
    squares += radius * radius;
  }
  const auto count = static_cast<double>(outline.size());
  const double spread_of_rim = std::sqrt(std::max(0.0, squares / count - sum * sum / (count * count)));
  if (spread_of_rim > kMostRimSpread + kOutlineErrorPx / axes[0]) return std::nullopt;
  // The outline runs through the centres of the outermost dark pixels, half a pixel inside the rim.
  const Vector2d rim = axes.array() + 0.5;
  const Matrix2d& directions = solver.eigenvectors();
  return CircleBlob{center, directions * rim.cwiseInverse().asDiagonal() * directions.transpose(),
                    std::numbers::pi * rim.prod()};
}

// Adds the ellipses of one threshold that weren't found before.
void AddBlobs(const cv::Mat& grey, int window_px, std::vector<CircleBlob>* blobs) {
  cv::Mat dark;
  cv::adaptiveThreshold(grey, dark, 255.0, cv::ADAPTIVE_THRESH_MEAN_C, cv::THRESH_BINARY_INV, window_px | 1,
                        kDarkerByLevels);
  std::vector<std::vector<cv::Point>> outlines;
  cv::findContours(dark, outlines, cv::RETR_LIST, cv::CHAIN_APPROX_NONE);
  const std::size_t before = blobs->size();
  for (const std::vector<cv::Point>& outline : outlines) {
    const auto blob = EllipseOf(outline, kMostAreaShare * static_cast<double>(grey.total()));
    if (!blob) continue;
    const auto is_known = [&](const CircleBlob& known) {
      return (known.unit_from_pixel * (known.pixel - blob->pixel)).norm() < 0.5;
    };
    if (std::none_of(blobs->begin(), blobs->begin() + static_cast<std::ptrdiff_t>(before), is_known))
      blobs->push_back(*blob);
  }
}

struct CircleLevels {
  double dark = 0.0;
  double light = 0.0;
  double noise = 0.0;  // standard deviation of a level, where all is light
};

// Calls visit(offset from the centre, distance in radii, level) for the pixels of the blob's window. False:
// the window isn't all in the picture.
template <typename Visit>
bool VisitWindow(const cv::Mat& grey, const Vector2d& center, const Matrix2d& unit_from_pixel,
                 const Visit& visit) {
  const Matrix2d pixel_from_unit = unit_from_pixel.inverse();
  const Vector2d reach = kWindow * pixel_from_unit.rowwise().norm();
  const Vector2d low = center - reach, high = center + reach;
  if (!(low.minCoeff() >= 0.0 && high.x() <= grey.cols - 1 && high.y() <= grey.rows - 1)) return false;
  for (int y = static_cast<int>(std::ceil(low.y())); y <= high.y(); ++y) {
    for (int x = static_cast<int>(std::ceil(low.x())); x <= high.x(); ++x) {
      const Vector2d offset = Vector2d(x, y) - center;
      const double radius = (unit_from_pixel * offset).norm();
      if (radius <= kWindow) visit(offset, radius, static_cast<double>(grey.at<unsigned char>(y, x)));
    }
  }
  return true;
}

std::optional<CircleLevels> LevelsOf(const cv::Mat& grey, const CircleBlob& blob) {
  double dark = 0.0, light = 0.0, squares = 0.0;
  int inside = 0, outside = 0;
  const auto add = [&](const Vector2d&, double radius, double level) {
    if (radius < kInside) {
      dark += level;
      ++inside;
    } else if (radius > kOutside) {
      light += level;
      squares += level * level;
      ++outside;
    }
  };
  if (!VisitWindow(grey, blob.pixel, blob.unit_from_pixel, add) || inside < 2 || outside < 8)
    return std::nullopt;
  CircleLevels levels{dark / inside, light / outside, 0.0};
  levels.noise = std::sqrt(std::max(0.0, squares / outside - levels.light * levels.light));
  if (!(levels.light - levels.dark >= kLeastCircleContrast)) return std::nullopt;
  return levels;
}

}  // namespace

std::vector<CircleBlob> FindCircleBlobs(const cv::Mat& grey) {
  std::vector<CircleBlob> blobs;
  const int size = std::max(grey.cols, grey.rows);
  for (const int share : {10, 30, 4}) AddBlobs(grey, std::max(11, size / share), &blobs);
  return blobs;
}

std::optional<CenterFit> FitCenter(const cv::Mat& grey, const CircleBlob& blob) {
  // Levels within a tenth of light or dark count as such, so that noise there doesn't move the centre.
  constexpr double kFlat = 0.1;
  CircleBlob at = blob;
  CenterFit fit;
  for (int round = 0; round < 2; ++round) {
    const auto levels = LevelsOf(grey, at);
    if (!levels) return std::nullopt;
    const double contrast = levels->light - levels->dark;
    double sum = 0.0, spread = 0.0;
    Vector2d moment = Vector2d::Zero();
    const auto add = [&](const Vector2d& offset, double, double level) {
      const double share = ((levels->light - level) / contrast - kFlat) / (1.0 - 2.0 * kFlat);
      sum += std::clamp(share, 0.0, 1.0);
      moment += std::clamp(share, 0.0, 1.0) * offset;
      if (share > 0.0 && share < 1.0) spread += offset.squaredNorm();
    };
    if (!VisitWindow(grey, at.pixel, at.unit_from_pixel, add) || !(sum > 0.0)) return std::nullopt;
    const Vector2d moved = moment / sum;
    if (!((blob.unit_from_pixel * (at.pixel + moved - blob.pixel)).norm() < 0.5)) return std::nullopt;
    at.pixel += moved;
    // The centre's error is the sum of (level's error) * offset / (contrast * area), on each axis half of it.
    const double noise_share = (levels->noise + 0.3) / (contrast * (1.0 - 2.0 * kFlat));
    fit = {at.pixel, std::hypot(noise_share * std::sqrt(0.5 * spread) / sum, kLeastCenterSigmaPx), contrast};
  }
  return fit;
}

}  // namespace elbowroom::recon
