#include "core/lens.h"

#include <fmt/format.h>

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
// A divisor that reaches zero yields an interval that no caller can take for a valid lens.
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

}  // namespace

Lens::Lens(DistortionModel model, const std::vector<double>& d, const std::string& who) : model_(model) {
  const auto fail = [&](const std::string& what) { throw Error(ErrorKind::kCamera, who + ": " + what); };
  if (!std::all_of(d.begin(), d.end(), [](double value) { return std::isfinite(value); })) {
    fail("a distortion coefficient is not a finite number; calibrate this camera again");
  }
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
}

double Lens::RadialImage(double radius) const {
  if (model_ == DistortionModel::kFisheye) {
    const double theta = std::atan(radius);
    return theta * SeriesAt(k_, 4, theta * theta);
  }
  const double t = radius * radius;
  return radius * SeriesAt(k_, 3, t) / SeriesAt(k_ + 3, 3, t);
}

Interval Lens::RadialScale(double r0, double r1) const {
  if (model_ == DistortionModel::kFisheye) {
    const double a = std::atan(r0), b = std::atan(r1);
    // theta / tan(theta) falls from 1.
    const Interval ratio{r1 > 0.0 ? b / r1 : 1.0, r0 > 0.0 ? a / r0 : 1.0};
    return ratio * Series(k_, 4, {a * a, b * b});
  }
  const Interval t{r0 * r0, r1 * r1};
  return Series(k_, 3, t) / Series(k_ + 3, 3, t);
}

Interval Lens::RadialSlope(double r0, double r1) const {
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

double Lens::InvertRadial(double image_radius, double max_radius) const {
  // Monotone up to max_radius: Newton, kept within a bracket that shrinks with every step.
  double low = 0.0, high = max_radius;
  double radius = std::min(image_radius, max_radius);
  for (int i = 0; i < 100; ++i) {
    const double excess = RadialImage(radius) - image_radius;
    (excess < 0.0 ? low : high) = radius;
    double next = radius - excess / RadialSlope(radius, radius).upper;
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    if (std::abs(next - radius) <= 4e-16 * max_radius || next == low || next == high) return next;
    radius = next;
  }
  return radius;
}

std::optional<Eigen::Vector2d> Lens::Undistort(const Eigen::Vector2d& distorted, double max_radius) const {
  if (is_ideal_) return distorted.norm() <= max_radius ? std::optional(distorted) : std::nullopt;
  // The off-axis terms are small and follow by fixed-point iteration around the radial part's inverse.
  Eigen::Vector2d x = Eigen::Vector2d::Zero();
  for (int i = 0; i < 50; ++i) {
    const Eigen::Vector2d radial_part = distorted - OffAxis(x);
    const double image_radius = radial_part.norm();
    const Eigen::Vector2d next =
        image_radius < 1e-15
            ? Eigen::Vector2d::Zero()
            : Eigen::Vector2d(radial_part * (InvertRadial(image_radius, max_radius) / image_radius));
    const bool settled = (next - x).norm() <= 1e-14;
    x = next;
    if (settled) break;
  }
  if ((Distort(x) - distorted).norm() > 1e-9 * std::max(1.0, distorted.norm())) return std::nullopt;
  return x;
}

}  // namespace elbowroom::core
