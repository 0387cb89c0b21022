#include "recon/calibration/lens_projection.h"

#include <Eigen/LU>
#include <array>
#include <cmath>

namespace elbowroom::recon {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;
using Eigen::Vector3d;

// Where the denominator of a rational lens vanishes, the numerator of a fit vanishes too: the lens is that of
// lower orders, and the derivatives by the coefficients have no bounds. No real lens comes near it.
constexpr double kLeastDenominator = 0.05;

// A point of the distorted plane, and its derivatives by the normalised point.
struct DistortedPoint {
  Vector2d at;
  Matrix2d by_normalised;
};
// The derivatives by the coefficients.
using ByCoefficients = Eigen::Matrix<double, 2, Eigen::Dynamic, 0, 2, kMostIntrinsics>;

// Coefficients in the order of the formulas; those that a lens doesn't have are 0.
struct PolynomialLens {
  std::array<double, 6> k{};  // k4 to k6: the denominator
  double p1 = 0.0, p2 = 0.0;
  std::array<double, 4> s{};

  explicit PolynomialLens(const Eigen::VectorXd& values) {
    const auto at = [&](int i) { return 4 + i < values.size() ? values[4 + i] : 0.0; };
    k = {at(0), at(1), at(4), at(5), at(6), at(7)};
    p1 = at(2);
    p2 = at(3);
    s = {at(8), at(9), at(10), at(11)};
  }
  [[nodiscard]] double Numerator(double t) const { return 1.0 + t * (k[0] + t * (k[1] + t * k[2])); }
  [[nodiscard]] double Denominator(double t) const { return 1.0 + t * (k[3] + t * (k[4] + t * k[5])); }
  [[nodiscard]] Vector2d OffAxis(const Vector2d& n, double t) const {
    return {2.0 * p1 * n.x() * n.y() + p2 * (t + 2.0 * n.x() * n.x()) + t * (s[0] + t * s[1]),
            p1 * (t + 2.0 * n.y() * n.y()) + 2.0 * p2 * n.x() * n.y() + t * (s[2] + t * s[3])};
  }
};

std::optional<Vector2d> DistortPolynomial(const PolynomialLens& lens, const Vector2d& n) {
  const double t = n.squaredNorm(), denominator = lens.Denominator(t);
  if (!(denominator > kLeastDenominator)) return std::nullopt;
  return n * (lens.Numerator(t) / denominator) + lens.OffAxis(n, t);
}

std::optional<DistortedPoint> DifferentiatePolynomial(const PolynomialLens& lens, const Vector2d& n) {
  const double x = n.x(), y = n.y(), t = n.squaredNorm();
  const double denominator = lens.Denominator(t);
  if (!(denominator > kLeastDenominator)) return std::nullopt;
  const double scale = lens.Numerator(t) / denominator;
  // The derivatives by t = x^2 + y^2 of numerator, denominator and their quotient.
  const auto& k = lens.k;
  const double numerator_by_t = k[0] + t * (2.0 * k[1] + 3.0 * t * k[2]);
  const double denominator_by_t = k[3] + t * (2.0 * k[4] + 3.0 * t * k[5]);
  const double scale_by_t = (numerator_by_t - scale * denominator_by_t) / denominator;

  DistortedPoint d;
  d.at = n * scale + lens.OffAxis(n, t);
  const double mixed = 2.0 * (lens.p1 * x + lens.p2 * y);
  d.by_normalised << 2.0 * lens.p1 * y + 6.0 * lens.p2 * x, mixed, mixed,
      6.0 * lens.p1 * y + 2.0 * lens.p2 * x;
  d.by_normalised += scale * Matrix2d::Identity() + 2.0 * scale_by_t * n * n.transpose();
  const Vector2d prism_by_t(lens.s[0] + 2.0 * t * lens.s[1], lens.s[2] + 2.0 * t * lens.s[3]);
  d.by_normalised += 2.0 * prism_by_t * n.transpose();
  return d;
}

void DifferentiateByPolynomial(const PolynomialLens& lens, const Vector2d& n, ByCoefficients* by) {
  const double x = n.x(), y = n.y(), t = n.squaredNorm();
  const double denominator = lens.Denominator(t), scale = lens.Numerator(t) / denominator;
  const Vector2d radial = n / denominator;
  const std::array<Vector2d, 12> all = {radial * t,
                                        radial * t * t,
                                        Vector2d(2.0 * x * y, t + 2.0 * y * y),
                                        Vector2d(t + 2.0 * x * x, 2.0 * x * y),
                                        radial * t * t * t,
                                        radial * (-scale * t),
                                        radial * (-scale * t * t),
                                        radial * (-scale * t * t * t),
                                        Vector2d(t, 0.0),
                                        Vector2d(t * t, 0.0),
                                        Vector2d(0.0, t),
                                        Vector2d(0.0, t * t)};
  by->setZero();  // the tilt of a sensor, beyond the twelfth, is 0 and isn't found
  for (Eigen::Index i = 0; i < std::min<Eigen::Index>(by->cols(), 12); ++i)
    by->col(i) = all[static_cast<std::size_t>(i)];
}

constexpr double kCentre = 1e-8;  // radius below which a fisheye's picture is the point itself

Vector2d DistortFisheye(const Eigen::VectorXd& v, const Vector2d& n) {
  const double radius = n.norm();
  if (radius < kCentre) return n;
  const double theta = std::atan(radius), t = theta * theta;
  return n * (theta * (1.0 + t * (v[4] + t * (v[5] + t * (v[6] + t * v[7])))) / radius);
}

DistortedPoint DifferentiateFisheye(const Eigen::VectorXd& v, const Vector2d& n) {
  const double radius = n.norm();
  if (radius < kCentre) return {n, Matrix2d::Identity()};
  const double theta = std::atan(radius), t = theta * theta;
  const double across = theta * (1.0 + t * (v[4] + t * (v[5] + t * (v[6] + t * v[7])))) / radius;
  const double along = (1.0 + t * (3.0 * v[4] + t * (5.0 * v[5] + t * (7.0 * v[6] + t * 9.0 * v[7])))) /
                       (1.0 + radius * radius);
  return {n * across,
          across * Matrix2d::Identity() + ((along - across) / (radius * radius)) * n * n.transpose()};
}

void DifferentiateByFisheye(const Vector2d& n, ByCoefficients* by) {
  by->setZero();
  const double radius = n.norm();
  if (radius < kCentre) return;
  const double theta = std::atan(radius), t = theta * theta;
  double power = theta / radius;
  for (int i = 0; i < 4; ++i) {
    power *= t;
    by->col(i) = n * power;
  }
}

Vector2d PixelOf(const LensParameters& lens, const Vector2d& distorted) {
  const Eigen::VectorXd& v = lens.values;
  return {v[0] * distorted.x() + lens.skew_px * distorted.y() + v[2], v[1] * distorted.y() + v[3]};
}

Vector2d DistortedOf(const LensParameters& lens, const Vector2d& pixel) {
  const Eigen::VectorXd& v = lens.values;
  const double y = (pixel.y() - v[3]) / v[1];
  return {(pixel.x() - v[2] - lens.skew_px * y) / v[0], y};
}

Matrix2d FocalMatrix(const LensParameters& lens) {
  Matrix2d focal;
  focal << lens.values[0], lens.skew_px, 0.0, lens.values[1];
  return focal;
}

int DistortionCount(core::DistortionModel model) {
  switch (model) {
    case core::DistortionModel::kPlumbBob:
      return 5;
    case core::DistortionModel::kRationalPolynomial:
      return 8;
    case core::DistortionModel::kFisheye:
      return 4;
  }
  return 0;
}

}  // namespace

LensParameters WithModel(const LensParameters& lens, core::DistortionModel model) {
  const bool is_polynomial_over_1 =
      lens.model == core::DistortionModel::kPlumbBob && model == core::DistortionModel::kRationalPolynomial;
  const int kept = is_polynomial_over_1 || lens.model == model ? lens.count() : 4;
  LensParameters other = lens;
  other.model = model;
  other.values = Eigen::VectorXd::Zero(4 + DistortionCount(model));
  other.values.head(kept) = lens.values.head(kept);
  return other;
}

LensParameters LensParametersOf(const core::CameraCalibration& calibration) {
  const Eigen::Matrix3d& k = calibration.camera_matrix;
  LensParameters lens;
  lens.model = calibration.distortion_model;
  lens.skew_px = k(0, 1);
  const auto& distortion = calibration.distortion_coefficients;
  // A fisheye has four coefficients, also where the last are left out.
  const std::size_t count = lens.model == core::DistortionModel::kFisheye ? 4 : distortion.size();
  lens.values = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(4 + count));
  lens.values.head<4>() << k(0, 0), k(1, 1), k(0, 2), k(1, 2);
  for (std::size_t i = 0; i < std::min(count, distortion.size()); ++i)
    lens.values[static_cast<Eigen::Index>(4 + i)] = distortion[i];
  return lens;
}

void PutLens(const LensParameters& lens, core::CameraCalibration* calibration) {
  const Eigen::VectorXd& v = lens.values;
  calibration->camera_matrix << v[0], lens.skew_px, v[2], 0.0, v[1], v[3], 0.0, 0.0, 1.0;
  calibration->distortion_model = lens.model;
  calibration->distortion_coefficients.assign(v.data() + 4, v.data() + v.size());
}

std::optional<Vector2d> ProjectPoint(const LensParameters& lens, const Vector3d& x_in_cam) {
  if (!(x_in_cam.z() > 0.0)) return std::nullopt;
  const Vector2d normalised = x_in_cam.head<2>() / x_in_cam.z();
  if (lens.model == core::DistortionModel::kFisheye)
    return PixelOf(lens, DistortFisheye(lens.values, normalised));
  const std::optional<Vector2d> distorted = DistortPolynomial(PolynomialLens(lens.values), normalised);
  if (!distorted) return std::nullopt;
  return PixelOf(lens, *distorted);
}

std::optional<PosedPixel> ProjectWithPointDerivative(const LensParameters& lens, const Vector3d& x_in_cam) {
  if (!(x_in_cam.z() > 0.0)) return std::nullopt;
  const double inverse_z = 1.0 / x_in_cam.z();
  const Vector2d normalised = x_in_cam.head<2>() * inverse_z;
  const std::optional<DistortedPoint> d =
      lens.model == core::DistortionModel::kFisheye
          ? DifferentiateFisheye(lens.values, normalised)
          : DifferentiatePolynomial(PolynomialLens(lens.values), normalised);
  if (!d) return std::nullopt;
  Eigen::Matrix<double, 2, 3> normalised_by_x;
  normalised_by_x << inverse_z, 0.0, -normalised.x() * inverse_z, 0.0, inverse_z, -normalised.y() * inverse_z;
  return PosedPixel{PixelOf(lens, d->at), FocalMatrix(lens) * d->by_normalised * normalised_by_x};
}

std::optional<ProjectedPoint> ProjectWithDerivatives(const LensParameters& lens, const Vector3d& x_in_cam) {
  const std::optional<PosedPixel> seen = ProjectWithPointDerivative(lens, x_in_cam);
  if (!seen) return std::nullopt;
  std::optional<ProjectedPoint> point(std::in_place);
  point->pixel = seen->pixel;
  point->by_x_in_cam = seen->by_x_in_cam;

  const Vector2d normalised = x_in_cam.head<2>() / x_in_cam.z();
  ByCoefficients by_coefficients(2, lens.count() - 4);
  if (lens.model == core::DistortionModel::kFisheye)
    DifferentiateByFisheye(normalised, &by_coefficients);
  else
    DifferentiateByPolynomial(PolynomialLens(lens.values), normalised, &by_coefficients);
  const Vector2d distorted = DistortedOf(lens, seen->pixel);
  point->by_values.setZero(2, lens.count());
  point->by_values(0, 0) = distorted.x();
  point->by_values(1, 1) = distorted.y();
  point->by_values(0, 2) = 1.0;
  point->by_values(1, 3) = 1.0;
  point->by_values.rightCols(by_coefficients.cols()).noalias() = FocalMatrix(lens) * by_coefficients;
  return point;
}

std::optional<Vector2d> NormalisedPoint(const LensParameters& lens, const Vector2d& pixel) {
  constexpr int kSteps = 30;
  constexpr double kSettledPx = 1e-9, kLargestRadius = 50.0;
  Vector2d at = DistortedOf(lens, pixel);
  if (lens.model == core::DistortionModel::kFisheye) {
    const double theta = at.norm();
    if (theta > 1e-6) at *= std::tan(std::min(theta, 1.5)) / theta;
  }
  for (int step = 0; step < kSteps; ++step) {
    const auto projected = ProjectWithPointDerivative(lens, {at.x(), at.y(), 1.0});
    if (!projected) return std::nullopt;
    const Vector2d residual = pixel - projected->pixel;
    if (residual.norm() < kSettledPx) return at;
    const Matrix2d by_point = projected->by_x_in_cam.leftCols<2>();
    if (!(by_point.determinant() > 0.0)) return std::nullopt;  // beyond the fold
    Vector2d move = by_point.inverse() * residual;
    const double longest = 0.3 * (1.0 + at.norm());
    if (move.norm() > longest) move *= longest / move.norm();
    at += move;
    if (!(at.norm() < kLargestRadius)) return std::nullopt;
  }
  return std::nullopt;
}

}  // namespace elbowroom::recon
