#include "core/lens.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace elbowroom::core {
namespace {

Interval operator+(Interval a, Interval b) { return {a.lower + b.lower, a.upper + b.upper}; }
Interval operator-(Interval a, Interval b) { return {a.lower - b.upper, a.upper - b.lower}; }
Interval operator*(Interval a, Interval b) {
  const auto [low, high] =
      std::minmax({a.lower * b.lower, a.lower * b.upper, a.upper * b.lower, a.upper * b.upper});
  return {low, high};
}
// A divisor that reaches zero yields an infinite interval, by which no caller finds a lens valid.
Interval operator/(Interval a, Interval b) {
  if (b.lower <= 0.0) return {-HUGE_VAL, HUGE_VAL};
  return a * Interval{1.0 / b.upper, 1.0 / b.lower};
}

// 1 + c0 t + c1 t^2 + c2 t^3 (+ c3 t^4) for t in an interval of non-negative values, and its derivative.
Interval Series(const double* c, int n, Interval t) {
  Interval sum{1.0, 1.0}, power{1.0, 1.0};
  for (int i = 0; i < n; ++i) {
    power = power * t;
    sum = sum + Interval{c[i], c[i]} * power;
  }
  return sum;
}
Interval SeriesSlope(const double* c, int n, Interval t) {
  Interval sum{0.0, 0.0}, power{1.0, 1.0};
  for (int i = 0; i < n; ++i) {
    const double factor = c[i] * (i + 1);
    sum = sum + Interval{factor, factor} * power;
    power = power * t;
  }
  return sum;
}
double SeriesAt(const double* c, int n, double t) {
  double sum = 0.0;
  for (int i = n - 1; i >= 0; --i) sum = (sum + c[i]) * t;
  return 1.0 + sum;
}
double SeriesSlopeAt(const double* c, int n, double t) {
  double sum = 0.0;
  for (int i = n - 1; i >= 0; --i) sum = sum * t + c[i] * (i + 1);
  return sum;
}

// Interval arithmetic treats numerator and denominator as independent, so its intervals are too wide for
// lenses whose coefficients nearly cancel. A stretch whose interval is wide is therefore cut into pieces, and
// the result is the interval that holds those of all pieces.
template <typename Enclosure>
Interval EncloseTightly(const Enclosure& enclose, double r0, double r1) {
  constexpr double kWidth = 0.01;  // of the slope and the scale, which are about 1
  constexpr int kPieces = 256;
  const Interval whole = enclose(r0, r1);
  if (whole.upper - whole.lower <= kWidth) return whole;
  Interval hull{HUGE_VAL, -HUGE_VAL};
  for (int i = 0; i < kPieces; ++i) {
    const Interval piece = enclose(r0 + (r1 - r0) * i / kPieces, r0 + (r1 - r0) * (i + 1) / kPieces);
    hull = {std::min(hull.lower, piece.lower), std::max(hull.upper, piece.upper)};
  }
  return hull;
}

}  // namespace

Lens::Lens(DistortionModel model, const std::vector<double>& coefficients, const std::string& who)
    : model_(model) {
  const auto fail = [&](const std::string& what) { throw Error(ErrorKind::kCamera, who + ": " + what); };
  std::vector<double> d = coefficients;
  if (!std::all_of(d.begin(), d.end(), [](double value) { return std::isfinite(value); })) {
    fail("a distortion coefficient is not a finite number; calibrate this camera again");
  }
  std::replace_if(
      d.begin(), d.end(), [](double value) { return std::abs(value) < kLeastCoefficient; }, 0.0);
  if (model == DistortionModel::kFisheye) {
    if (!d.empty() && d.size() != 4)
      fail(fmt::format("fisheye takes 4 distortion coefficients, not {}", d.size()));
    std::copy(d.begin(), d.end(), k_);
    return;
  }
  const std::size_t n = d.size();
  if (n != 0 && n != 4 && n != 5 && n != 8 && n != 12 && n != 14) {
    fail(fmt::format("{} takes 0, 4, 5, 8, 12 or 14 distortion coefficients, not {}", ToString(model), n));
  }
  if (model == DistortionModel::kPlumbBob && n > 5) {
    fail(fmt::format("plumb_bob takes at most 5 distortion coefficients, not {}; say \"rational_polynomial\"",
                     n));
  }
  const auto at = [&](std::size_t i) { return i < n ? d[i] : 0.0; };
  k_[0] = at(0), k_[1] = at(1), p1_ = at(2), p2_ = at(3);
  for (std::size_t i = 4; i < 8; ++i) k_[i - 2] = at(i);
  for (std::size_t i = 0; i < 4; ++i) s_[i] = at(8 + i);
  if (at(12) != 0.0 || at(13) != 0.0)
    fail("a tilted sensor model is not supported; calibrate without CALIB_TILTED_MODEL");
  is_ideal_ = std::all_of(d.begin(), d.end(), [](double value) { return value == 0.0; });
  has_off_axis_ = p1_ != 0.0 || p2_ != 0.0 || std::any_of(s_, s_ + 4, [](double s) { return s != 0.0; });
}

double Lens::RadialImage(double radius) const {
  if (model_ == DistortionModel::kFisheye) {
    const double theta = std::atan(radius);
    return theta * SeriesAt(k_, 4, theta * theta);
  }
  const double t = radius * radius;
  return radius * SeriesAt(k_, 3, t) / SeriesAt(k_ + 3, 3, t);
}

double Lens::RadialSlopeAt(double radius) const {
  if (model_ == DistortionModel::kFisheye) {
    const double theta = std::atan(radius), t = theta * theta;
    return (SeriesAt(k_, 4, t) + 2.0 * t * SeriesSlopeAt(k_, 4, t)) / (1.0 + radius * radius);
  }
  const double t = radius * radius, n = SeriesAt(k_, 3, t), d = SeriesAt(k_ + 3, 3, t);
  return n / d + 2.0 * t * (SeriesSlopeAt(k_, 3, t) * d - n * SeriesSlopeAt(k_ + 3, 3, t)) / (d * d);
}

Interval Lens::RadialScale(double r0, double r1) const {
  return EncloseTightly([&](double a, double b) { return RadialScaleOf(a, b); }, r0, r1);
}

Interval Lens::RadialSlope(double r0, double r1) const {
  return EncloseTightly([&](double a, double b) { return RadialSlopeOf(a, b); }, r0, r1);
}

Interval Lens::RadialScaleOf(double r0, double r1) const {
  if (model_ == DistortionModel::kFisheye) {
    const double a = std::atan(r0), b = std::atan(r1);
    // theta / tan(theta) falls from 1 as theta grows, so its values at the ends are its bounds.
    const Interval ratio{r1 > 0.0 ? b / r1 : 1.0, r0 > 0.0 ? a / r0 : 1.0};
    return ratio * Series(k_, 4, {a * a, b * b});
  }
  const Interval t{r0 * r0, r1 * r1};
  return Series(k_, 3, t) / Series(k_ + 3, 3, t);
}

Interval Lens::RadialSlopeOf(double r0, double r1) const {
  if (model_ == DistortionModel::kFisheye) {
    const double a = std::atan(r0), b = std::atan(r1);
    const Interval t{a * a, b * b};
    const Interval theta_slope = Series(k_, 4, t) + Interval{2.0, 2.0} * t * SeriesSlope(k_, 4, t);
    return theta_slope * Interval{1.0 / (1.0 + r1 * r1), 1.0 / (1.0 + r0 * r0)};
  }
  const Interval t{r0 * r0, r1 * r1};
  const Interval n = Series(k_, 3, t), d = Series(k_ + 3, 3, t);
  const Interval quotient_slope = (SeriesSlope(k_, 3, t) * d - n * SeriesSlope(k_ + 3, 3, t)) / (d * d);
  return n / d + Interval{2.0, 2.0} * t * quotient_slope;
}

double Lens::OffAxisSlope(double radius) const {
  // Each entry of the tangential terms' Jacobian is bounded by |x|, |y| <= radius; the Frobenius norm of
  // these bounds is no less than the Jacobian's norm. The prism terms' Jacobian is an outer product with x,
  // whose norm is the product of the two lengths.
  const double p1 = std::abs(p1_), p2 = std::abs(p2_), r3 = radius * radius * radius;
  const double tangential =
      radius * std::sqrt(std::pow(2 * p1 + 6 * p2, 2) + 2 * std::pow(2 * p1 + 2 * p2, 2) +
                         std::pow(6 * p1 + 2 * p2, 2));
  return tangential + std::hypot(2 * std::abs(s_[0]) * radius + 4 * std::abs(s_[1]) * r3,
                                 2 * std::abs(s_[2]) * radius + 4 * std::abs(s_[3]) * r3);
}

double Lens::OffAxisLength(double radius) const {
  // The slope bound grows with the radius and the terms vanish at the centre.
  return OffAxisSlope(radius) * radius;
}

Eigen::Vector2d Lens::OffAxis(const Eigen::Vector2d& x) const {
  const double r2 = x.squaredNorm(), xy = x.x() * x.y();
  return {2 * p1_ * xy + p2_ * (r2 + 2 * x.x() * x.x()) + s_[0] * r2 + s_[1] * r2 * r2,
          p1_ * (r2 + 2 * x.y() * x.y()) + 2 * p2_ * xy + s_[2] * r2 + s_[3] * r2 * r2};
}

Eigen::Vector2d Lens::Distort(const Eigen::Vector2d& normalised) const {
  if (is_ideal_) return normalised;
  if (model_ == DistortionModel::kFisheye) {
    const double radius = normalised.norm();
    if (radius < 1e-12) return normalised;
    return normalised * (RadialImage(radius) / radius);
  }
  const double t = normalised.squaredNorm();
  return normalised * (SeriesAt(k_, 3, t) / SeriesAt(k_ + 3, 3, t)) + OffAxis(normalised);
}

Eigen::Matrix2d Lens::Slope(const Eigen::Vector2d& x) const {
  // The Jacobian of x R(r)/r stretches by R' along x and by R/r across it.
  const double r2 = x.squaredNorm(), radius = std::sqrt(r2);
  Eigen::Matrix2d slope = Eigen::Matrix2d::Identity();
  if (radius > 1e-12) {
    const double across = RadialImage(radius) / radius, along = RadialSlopeAt(radius);
    slope = across * Eigen::Matrix2d::Identity() + ((along - across) / r2) * x * x.transpose();
  }
  if (!has_off_axis_) return slope;
  const Eigen::Vector2d prism(2 * s_[0] + 4 * s_[1] * r2, 2 * s_[2] + 4 * s_[3] * r2);
  Eigen::Matrix2d tangential;
  tangential << 2 * p1_ * x.y() + 6 * p2_ * x.x(), 2 * p1_ * x.x() + 2 * p2_ * x.y(),
      2 * p1_ * x.x() + 2 * p2_ * x.y(), 6 * p1_ * x.y() + 2 * p2_ * x.x();
  return slope + tangential + prism * x.transpose();
}

std::optional<Eigen::Vector2d> Lens::UndistortNear(const Eigen::Vector2d& distorted,
                                                   const Eigen::Vector2d& start, double max_radius) const {
  constexpr int kSteps = 6;
  constexpr double kLastStep = 1e-10;  // the error after such a step is of the order of its square
  constexpr double kRim = 1e-6;        // share of the radius; nearer to the rim than this, Undistort decides
  Eigen::Vector2d x = start;
  for (int i = 0; i < kSteps; ++i) {
    const Eigen::Vector2d step = Slope(x).inverse() * (distorted - Distort(x));
    x += step;
    if (!(x.norm() < max_radius * (1.0 - kRim))) return std::nullopt;
    if (step.norm() <= kLastStep) return x;
  }
  return std::nullopt;
}

double Lens::RadiusFromImage(double image_radius, double start, double max_radius) const {
  // Newton's method within a bracket, which is valid because R grows throughout the domain. A step that
  // leaves the bracket is replaced by halving it.
  if (RadialImage(max_radius) <= image_radius) return max_radius;
  double low = 0.0, high = max_radius, radius = std::min(start, max_radius);
  constexpr double kSettled = 4e-15;  // relative: rounding of the image radius is no smaller
  for (int i = 0; i < 100; ++i) {
    const double excess = RadialImage(radius) - image_radius;
    (excess < 0.0 ? low : high) = radius;
    double next = radius - excess / RadialSlopeAt(radius);
    if (!(next >= low && next <= high)) next = 0.5 * (low + high);
    const bool settled = std::abs(next - radius) <= kSettled * radius;
    radius = next;
    if (settled) break;
  }
  return radius;
}

std::optional<Eigen::Vector2d> Lens::Undistort(const Eigen::Vector2d& distorted, double max_radius) const {
  if (is_ideal_) return distorted.norm() <= max_radius ? std::optional(distorted) : std::nullopt;
  // The radial part is inverted by RadiusFromImage; the small off-axis terms by fixed-point iteration around
  // it.
  Eigen::Vector2d x = Eigen::Vector2d::Zero();
  double radius = distorted.norm();
  for (int i = 0; i < 50; ++i) {
    const Eigen::Vector2d radial_part = has_off_axis_ ? distorted - OffAxis(x) : distorted;
    const double image_radius = radial_part.norm();
    radius = RadiusFromImage(image_radius, radius, max_radius);
    const Eigen::Vector2d next = image_radius < 1e-15
                                     ? Eigen::Vector2d::Zero()
                                     : Eigen::Vector2d(radial_part * (radius / image_radius));
    const bool settled = !has_off_axis_ || (next - x).norm() <= 1e-14;
    x = next;
    if (settled) break;
  }
  if ((Distort(x) - distorted).norm() > 1e-9 * std::max(1.0, distorted.norm())) return std::nullopt;
  return x;
}

}  // namespace elbowroom::core
