#include "recon/boards/edge_fit.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "recon/boards/level_fit.h"

namespace elbowroom::recon {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;

constexpr double kAlongFrom = 0.08, kAlongTo = 0.5;  // shares of the side
constexpr double kCornerBlurPx = 1.5;                // next to the corner the other edge shows
constexpr double kAcrossModules = 0.9;
constexpr double kFurthestModules = 1.5;
constexpr double kLeastEdgeExplained = 0.6;
constexpr double kLeastEdgeContrast = 8.0;
constexpr double kLeastEdgeSigmaPx = 0.01;
constexpr double kWidestSharpPx = 1.5;  // of the step, where modules are smaller

// Angle of the normal, which points into the dark square; distance of the edge from the window's origin;
// levels c, d; logarithm of the step's width.
constexpr int kEdgeParameters = 5;
using EdgeParameters = Eigen::Matrix<double, kEdgeParameters, 1>;

struct FittedEdge {
  Vector2d origin;
  LevelFit<kEdgeParameters> fit;
};

double EdgeLevel(const EdgeParameters& x, const Vector2d& offset, EdgeParameters* gradient) {
  const Vector2d normal(std::cos(x[0]), std::sin(x[0]));
  const double per_width = std::exp(-x[4]);
  const double l = (normal.dot(offset) - x[1]) * per_width;
  const double s = std::tanh(l);
  const double slope = x[3] * (1.0 - s * s);
  (*gradient) << slope * per_width * (normal.x() * offset.y() - normal.y() * offset.x()), -slope * per_width,
      1.0, s, -slope * l;
  return x[2] + x[3] * s;
}

// The pixels on both sides of the edge from `corner` along `side`; `other` is the square's other edge there.
std::vector<LevelSample> SamplesOfEdge(const cv::Mat& grey, const Vector2d& corner, const Vector2d& side,
                                       const Vector2d& other, int modules, const Vector2d& origin) {
  Matrix2d axes;
  axes << side, other;
  const Matrix2d shares_from_pixel = axes.inverse();
  const double from = std::max(kAlongFrom, kCornerBlurPx / side.norm());
  const double across = kAcrossModules / modules;
  Vector2d low = corner, high = corner;
  for (const double a : {from, kAlongTo}) {
    for (const double b : {-across, across}) {
      const Vector2d pixel = corner + axes * Vector2d(a, b);
      low = low.cwiseMin(pixel);
      high = high.cwiseMax(pixel);
    }
  }
  std::vector<LevelSample> samples;
  if (!(low.minCoeff() >= 0.0 && high.x() <= grey.cols - 1 && high.y() <= grey.rows - 1)) return samples;
  for (int y = static_cast<int>(std::ceil(low.y())); y <= high.y(); ++y) {
    for (int x = static_cast<int>(std::ceil(low.x())); x <= high.x(); ++x) {
      const Vector2d q = shares_from_pixel * (Vector2d(x, y) - corner);
      if (q.x() < from || q.x() > kAlongTo || std::abs(q.y()) > across) continue;
      samples.push_back({Vector2d(x, y) - origin, static_cast<double>(grey.at<unsigned char>(y, x))});
    }
  }
  return samples;
}

std::optional<FittedEdge> FitEdge(const cv::Mat& grey, const Vector2d& corner, const Vector2d& side,
                                  const Vector2d& other, int modules) {
  const Vector2d origin = corner + 0.5 * (kAlongFrom + kAlongTo) * side;
  const std::vector<LevelSample> samples = SamplesOfEdge(grey, corner, side, other, modules, origin);
  if (samples.size() < static_cast<std::size_t>(kEdgeParameters) + 5) return std::nullopt;
  double sum = 0.0, squares = 0.0, low = 255.0, high = 0.0;
  for (const LevelSample& sample : samples) {
    sum += sample.level;
    squares += sample.level * sample.level;
    low = std::min(low, sample.level);
    high = std::max(high, sample.level);
  }
  Vector2d normal = Vector2d(-side.y(), side.x()).normalized();
  if (normal.dot(other) < 0.0) normal = -normal;
  EdgeParameters start;
  start << std::atan2(normal.y(), normal.x()), 0.0, 0.5 * (low + high), -0.5 * (high - low), 0.0;
  const double widest = std::log(std::max(kWidestSharpPx, std::abs(normal.dot(other)) / modules));
  const auto hold = [widest](EdgeParameters* x) { (*x)[4] = std::clamp((*x)[4], std::log(0.3), widest); };
  const auto fit = FitLevels<kEdgeParameters>(samples, start, EdgeLevel, hold);
  if (!fit || !(-2.0 * fit->parameters[3] >= kLeastEdgeContrast)) return std::nullopt;
  const double variance = squares - sum * sum / static_cast<double>(samples.size());
  if (!(fit->sum_of_squares <= (1.0 - kLeastEdgeExplained) * variance)) return std::nullopt;
  return FittedEdge{origin, *fit};
}

Vector2d NormalOf(const FittedEdge& edge) {
  return {std::cos(edge.fit.parameters[0]), std::sin(edge.fit.parameters[0])};
}

// Of the edge's distance from a point, along the normal.
double VarianceAt(const FittedEdge& edge, const Vector2d& pixel) {
  const Vector2d normal = NormalOf(edge), offset = pixel - edge.origin;
  const Vector2d gradient(normal.x() * offset.y() - normal.y() * offset.x(), -1.0);
  return gradient.dot(edge.fit.covariance.topLeftCorner<2, 2>() * gradient);
}

}  // namespace

std::optional<CornerFit> FitCorner(const cv::Mat& grey, const Vector2d& corner, const Vector2d& before,
                                   const Vector2d& after, int modules) {
  const Vector2d side1 = before - corner, side2 = after - corner;
  const double area = std::abs(side1.x() * side2.y() - side1.y() * side2.x());
  if (!(area > 16.0) || !corner.allFinite()) return std::nullopt;
  const auto edge1 = FitEdge(grey, corner, side1, side2, modules);
  const auto edge2 = FitEdge(grey, corner, side2, side1, modules);
  if (!edge1 || !edge2) return std::nullopt;
  Matrix2d normals;
  normals << NormalOf(*edge1).transpose(), NormalOf(*edge2).transpose();
  if (!(std::abs(normals.determinant()) > 0.1)) return std::nullopt;
  const Vector2d distances(NormalOf(*edge1).dot(edge1->origin) + edge1->fit.parameters[1],
                           NormalOf(*edge2).dot(edge2->origin) + edge2->fit.parameters[1]);
  const Matrix2d inverse = normals.inverse();
  const Vector2d pixel = inverse * distances;
  const double module_px = std::max(std::sqrt(area) / modules, 1.5);
  if (!((pixel - corner).norm() <= kFurthestModules * module_px)) return std::nullopt;
  const Vector2d variances(VarianceAt(*edge1, pixel), VarianceAt(*edge2, pixel));
  const double variance_px2 = 0.5 * (inverse * variances.asDiagonal() * inverse.transpose()).trace();
  if (!(variance_px2 < module_px * module_px)) return std::nullopt;
  return CornerFit{pixel, std::hypot(std::sqrt(variance_px2), kLeastEdgeSigmaPx)};
}

}  // namespace elbowroom::recon
