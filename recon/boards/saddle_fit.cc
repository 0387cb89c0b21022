#include "recon/boards/saddle_fit.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "recon/boards/level_fit.h"

namespace elbowroom::recon {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;

constexpr double kWindowSquares = 0.42;
constexpr double kWindowPx = 12.0;
constexpr double kFurthestSquares = 0.35;  // from where the point was expected
constexpr double kMostTurn = 0.45;         // of a line, in radians
constexpr double kLeastExplained = 0.7;    // share of the levels' variance
constexpr double kLeastContrast = 8.0;     // between light and dark, in grey levels
constexpr double kLeastSigmaPx = 0.01;     // a picture isn't the model
constexpr double kNarrowestPx = 0.3;       // of the step between light and dark
// Light that spreads from a marker's side into its square.
constexpr double kMarkerBlurPx = 1.2;

// x, y of the crossing; directions of the lines' normals; c, d of the levels; logarithm of the step's width.
constexpr int kParameters = 7;
using Parameters = Eigen::Matrix<double, kParameters, 1>;

double CrossingLevel(const Parameters& x, const Vector2d& offset, Parameters* gradient) {
  const Vector2d normal1(std::cos(x[2]), std::sin(x[2])), normal2(std::cos(x[3]), std::sin(x[3]));
  const double per_width = std::exp(-x[6]);
  const Vector2d r = (offset - x.head<2>()) * per_width;
  const double l1 = normal1.dot(r), l2 = normal2.dot(r);
  const double s1 = std::tanh(l1), s2 = std::tanh(l2);
  const double slope1 = x[5] * (1.0 - s1 * s1) * s2, slope2 = x[5] * s1 * (1.0 - s2 * s2);
  gradient->head<2>() = -per_width * (slope1 * normal1 + slope2 * normal2);
  (*gradient)[2] = slope1 * (normal1.x() * r.y() - normal1.y() * r.x());
  (*gradient)[3] = slope2 * (normal2.x() * r.y() - normal2.y() * r.x());
  (*gradient)[4] = 1.0;
  (*gradient)[5] = s1 * s2;
  (*gradient)[6] = -(slope1 * l1 + slope2 * l2);
  return x[4] + x[5] * s1 * s2;
}

// A pixel of the window, and the quadrant it is in: bit 0 past the point along the columns, bit 1 along the
// rows.
struct Window {
  std::vector<LevelSample> samples;
  std::array<double, 4> level_sum{};
  std::array<int, 4> count{};
};

// Pixels within `half` squares of the point on both axes, without those that a marker may darken.
std::optional<Window> Gather(const cv::Mat& grey, const LocalLattice& at, const Matrix2d& squares_from_pixel,
                             const Vector2d& half, const SaddleFitOptions& options) {
  const Vector2d reach = at.pixel_from_squares.cwiseAbs() * half;
  const Vector2d low = at.pixel - reach, high = at.pixel + reach;
  if (!(low.minCoeff() >= 0.0 && high.x() <= grey.cols - 1 && high.y() <= grey.rows - 1)) return std::nullopt;
  const Vector2d empty = Vector2d::Constant(options.empty_squares) -
                         kMarkerBlurPx * at.pixel_from_squares.colwise().norm().cwiseInverse().transpose();
  const bool is_empty = options.empty_squares >= 0.5;
  Window window;
  for (int y = static_cast<int>(std::ceil(low.y())); y <= high.y(); ++y) {
    const auto* row = grey.ptr<unsigned char>(y);
    for (int x = static_cast<int>(std::ceil(low.x())); x <= high.x(); ++x) {
      const Vector2d offset = Vector2d(x, y) - at.pixel;
      const Vector2d q = squares_from_pixel * offset;
      if (std::abs(q.x()) > half.x() || std::abs(q.y()) > half.y()) continue;
      const bool is_light = options.sign * q.x() * q.y() > 0.0;
      if (is_light && !is_empty && std::abs(q.x()) > empty.x() && std::abs(q.y()) > empty.y()) continue;
      const double level = row[x];
      window.samples.push_back({offset, level});
      const std::size_t quadrant = (q.x() > 0.0 ? 1U : 0U) + (q.y() > 0.0 ? 2U : 0U);
      window.level_sum[quadrant] += level;
      ++window.count[quadrant];
    }
  }
  return window;
}

// Whether each quadrant is on its side of the middle, which a T of edges isn't.
bool HasFourQuadrants(const Window& window, int sign, double* middle, double* half_contrast) {
  std::array<double, 4> mean{};
  for (std::size_t i = 0; i < 4; ++i) {
    if (window.count[i] == 0) return false;
    mean[i] = window.level_sum[i] / window.count[i];
  }
  const double same = sign * 0.5 * (mean[0] + mean[3]), other = sign * 0.5 * (mean[1] + mean[2]);
  *middle = sign * 0.5 * (same + other);
  *half_contrast = sign * 0.5 * (same - other);
  const double least_of_light = std::min(sign * mean[0], sign * mean[3]);
  const double most_of_dark = std::max(sign * mean[1], sign * mean[2]);
  return same - other > 0.5 * kLeastContrast && least_of_light - most_of_dark > 0.35 * (same - other);
}

double AngleOf(const Vector2d& v) { return std::atan2(v.y(), v.x()); }

// The normal of the line along `along`, on the side of `ahead`.
double NormalAngle(const Vector2d& along, const Vector2d& ahead) {
  const Vector2d normal(-along.y(), along.x());
  return AngleOf(normal.dot(ahead) < 0.0 ? Vector2d(-normal) : normal);
}

double VarianceSum(const Window& window) {
  double sum = 0.0, squares = 0.0;
  for (const LevelSample& sample : window.samples) {
    sum += sample.level;
    squares += sample.level * sample.level;
  }
  return squares - sum * sum / static_cast<double>(window.samples.size());
}

}  // namespace

std::optional<SaddleFit> FitSaddle(const cv::Mat& grey, const LocalLattice& near,
                                   const SaddleFitOptions& options) {
  const Matrix2d& axes = near.pixel_from_squares;
  const Vector2d lengths = axes.colwise().norm();
  const double area = std::abs(axes.determinant());
  // A square less than 2.5 px high has no levels of its own.
  const double height_px = area / lengths.maxCoeff();
  if (!(height_px >= 2.5) || !near.pixel.allFinite()) return std::nullopt;
  const Matrix2d squares_from_pixel = axes.inverse();
  const Vector2d half = (kWindowPx * lengths.cwiseInverse()).cwiseMin(kWindowSquares);
  const std::optional<Window> window = Gather(grey, near, squares_from_pixel, half, options);
  double middle = 0.0, half_contrast = 0.0;
  if (!window || !HasFourQuadrants(*window, options.sign, &middle, &half_contrast)) return std::nullopt;
  Parameters start;
  start << 0.0, 0.0, NormalAngle(axes.col(1), axes.col(0)), NormalAngle(axes.col(0), axes.col(1)), middle,
      half_contrast, std::log(std::clamp(0.1 * height_px, 0.8, 3.0));
  const double widest = std::log(std::max(0.4 * height_px, 2.0 * kNarrowestPx));
  const auto hold = [&](Parameters* x) { (*x)[6] = std::clamp((*x)[6], std::log(kNarrowestPx), widest); };
  const auto fit = FitLevels<kParameters>(window->samples, start, CrossingLevel, hold);
  if (!fit) return std::nullopt;
  const Vector2d moved = squares_from_pixel * fit->parameters.head<2>();
  const Vector2d turned = (fit->parameters.segment<2>(2) - start.segment<2>(2)).cwiseAbs();
  if (!(moved.cwiseAbs().maxCoeff() <= kFurthestSquares && turned.maxCoeff() <= kMostTurn) ||
      !(options.sign * fit->parameters[5] >= 0.5 * kLeastContrast) ||
      !(fit->sum_of_squares <= (1.0 - kLeastExplained) * VarianceSum(*window)))
    return std::nullopt;
  const double variance_px2 = 0.5 * fit->covariance.topLeftCorner<2, 2>().trace();
  if (!(variance_px2 < 0.01 * area)) return std::nullopt;
  return SaddleFit{near.pixel + fit->parameters.head<2>(), std::hypot(std::sqrt(variance_px2), kLeastSigmaPx),
                   2.0 * std::abs(fit->parameters[5])};
}

}  // namespace elbowroom::recon
