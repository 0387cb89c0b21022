#include "core/camera_model.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/error.h"
#include "core/lens.h"

namespace elbowroom::core {
namespace {

constexpr int kStretchBins = 256;

// Values beyond these are a mistake or damage.
constexpr int kLongestSidePx = 32'768;
constexpr std::int64_t kMostPixels = 200'000'000;
constexpr double kLargestFigure = 1e9;

void ValidateCalibration(const CameraCalibration& c) {
  const auto fail = [&](const std::string& what) {
    throw Error(ErrorKind::kCamera, fmt::format("camera '{}': {}", c.name, what));
  };
  if (c.image_width_px <= 0 || c.image_height_px <= 0) {
    fail(fmt::format("image size {} x {} is not positive; say how many pixels wide and high its pictures are",
                     c.image_width_px, c.image_height_px));
  }
  if (c.image_width_px > kLongestSidePx || c.image_height_px > kLongestSidePx ||
      std::int64_t{c.image_width_px} * c.image_height_px > kMostPixels) {
    fail(fmt::format(
        "image size {} x {} is more than a picture can have ({} px a side, {} in all); correct it",
        c.image_width_px, c.image_height_px, kLongestSidePx, kMostPixels));
  }
  const Eigen::Matrix3d& k = c.camera_matrix;
  if (!k.allFinite()) fail("camera_matrix has an entry that is not a finite number");
  if (k(1, 0) != 0.0 || k(2, 0) != 0.0 || k(2, 1) != 0.0 || k(2, 2) != 1.0) {
    fail("camera_matrix must be [fx s cx; 0 fy cy; 0 0 1]");
  }
  if (!(k(0, 0) > 0.0) || !(k(1, 1) > 0.0)) {
    fail(fmt::format("camera_matrix is singular or mirrored: fx = {}, fy = {}; both must be positive",
                     k(0, 0), k(1, 1)));
  }
  if (std::min(k(0, 0), k(1, 1)) < 1.0 / kLargestFigure || k.cwiseAbs().maxCoeff() > kLargestFigure)
    fail(fmt::format("camera_matrix has an entry beyond {}, or a focal length below {}; calibrate it again",
                     kLargestFigure, 1.0 / kLargestFigure));
  if (std::ranges::any_of(c.distortion_coefficients, [](double d) { return std::abs(d) > kLargestFigure; }))
    fail(fmt::format("a distortion coefficient is beyond {}; calibrate this camera again", kLargestFigure));
  if (!IsRotation(c.cam_from_world.rotation)) {
    fail(
        "rotation_cam_from_world is not a rotation (its rows must be orthonormal, determinant +1); calibrate "
        "the pose again");
  }
  if (!c.cam_from_world.translation_mm.allFinite()) fail("translation_cam_from_world_mm is not finite");
}

// The rotation nearest to a matrix that is almost one (Frobenius norm). A matrix that is a rotation to
// rounding is returned unchanged.
Eigen::Matrix3d NearestRotation(const Eigen::Matrix3d& matrix) {
  constexpr double kRounding = 1e-15;
  if (IsRotation(matrix, kRounding)) return matrix;
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
  return svd.matrixU() * svd.matrixV().transpose();
}

Lens LensOf(const CameraCalibration& c) {
  return {c.distortion_model, c.distortion_coefficients, fmt::format("camera '{}'", c.name)};
}

// The farthest corner of the picture from the principal point, as a radius in the distorted plane.
double FarthestCornerRadius(const CameraCalibration& c) {
  const Eigen::Matrix2d inverse = c.camera_matrix.topLeftCorner<2, 2>().inverse();
  double farthest = 0.0;
  for (const double u : {-0.5, c.image_width_px - 0.5}) {
    for (const double v : {-0.5, c.image_height_px - 0.5}) {
      const Eigen::Vector2d offset = Eigen::Vector2d(u, v) - c.camera_matrix.topRightCorner<2, 1>();
      farthest = std::max(farthest, (inverse * offset).norm());
    }
  }
  return farthest;
}

// The smallest radius (to the step) whose image is certainly outside of the picture, or, if that comes first,
// the largest up to which the lens is certainly one-to-one in radius: R' exceeds what the off-axis terms can
// take from it. Steps shrink where their bounds can't tell.
double DomainRadius(const Lens& lens, double corner_radius) {
  double radius = 0.0;
  while (radius < Lens::kLargestRadius) {
    double step = std::max(corner_radius / 256.0, radius * 0.01);
    const auto is_one_to_one = [&] {
      return lens.RadialSlope(radius, radius + step).lower - lens.OffAxisSlope(radius + step) > 0.0;
    };
    while (step > radius / 4096.0 && radius > 0.0 && !is_one_to_one()) step *= 0.5;
    if (!is_one_to_one()) break;  // the lens folds here
    radius = std::min(Lens::kLargestRadius, radius + step);
    if (lens.RadialImage(radius) - lens.OffAxisLength(radius) > corner_radius)
      break;  // the picture is covered
  }
  return radius;
}

}  // namespace

std::optional<DistortionModel> ParseDistortionModel(std::string_view text) {
  if (text == "plumb_bob") return DistortionModel::kPlumbBob;
  if (text == "rational_polynomial") return DistortionModel::kRationalPolynomial;
  if (text == "fisheye") return DistortionModel::kFisheye;
  return std::nullopt;
}

std::string_view ToString(DistortionModel model) {
  constexpr std::string_view kNames[] = {"plumb_bob", "rational_polynomial", "fisheye"};
  return kNames[static_cast<std::size_t>(model)];
}

CameraModel::CameraModel(CameraCalibration calibration) : calibration_(std::move(calibration)) {
  ValidateCalibration(calibration_);
  const auto lens = std::make_shared<const Lens>(LensOf(calibration_));
  lens_ = lens;
  cam_from_world_ = {NearestRotation(calibration_.cam_from_world.rotation),
                     calibration_.cam_from_world.translation_mm};
  center_in_world_ = cam_from_world_.Inverse().translation_mm;
  max_radius_ = DomainRadius(*lens, FarthestCornerRadius(calibration_));
  if (!(max_radius_ > 0.0)) {
    throw Error(ErrorKind::kCamera,
                fmt::format("camera '{}': the distortion coefficients describe no lens (the picture "
                            "folds at its centre); calibrate this camera again",
                            name()));
  }
  // The radial part stretches by R' along the radius and by R/r across it, the off-axis terms add no more
  // than their own slope, and the camera matrix stretches by no more than its largest singular value.
  const Eigen::Matrix2d scale = calibration_.camera_matrix.topLeftCorner<2, 2>();
  const double focal_px = Eigen::JacobiSVD<Eigen::Matrix2d>(scale).singularValues()(0);
  double running_maximum = 0.0;
  for (int i = 0; i < kStretchBins; ++i) {
    const double r0 = max_radius_ * i / kStretchBins, r1 = max_radius_ * (i + 1) / kStretchBins;
    const double radial = std::max(lens->RadialSlope(r0, r1).upper, lens->RadialScale(r0, r1).upper);
    running_maximum = std::max(running_maximum, radial + lens->OffAxisSlope(r1));
    stretch_px_.push_back(running_maximum * focal_px * (1.0 + 1e-12));
  }
}

bool CameraModel::is_ideal() const { return lens_->is_ideal(); }

std::optional<Eigen::Vector2d> CameraModel::ProjectInCam(const Eigen::Vector3d& x_in_cam) const {
  if (!(x_in_cam.z() > 0.0)) return std::nullopt;
  const Eigen::Vector2d normalised = x_in_cam.head<2>() / x_in_cam.z();
  if (!(normalised.norm() <= max_radius_)) return std::nullopt;
  return PixelFromNormalised(normalised);
}

Eigen::Vector2d CameraModel::PixelFromNormalised(const Eigen::Vector2d& normalised) const {
  const Eigen::Vector2d distorted = lens_->Distort(normalised);
  const Eigen::Matrix3d& k = calibration_.camera_matrix;
  return {k(0, 0) * distorted.x() + k(0, 1) * distorted.y() + k(0, 2), k(1, 1) * distorted.y() + k(1, 2)};
}

Eigen::Vector2d CameraModel::DistortedFromPixel(const Eigen::Vector2d& pixel) const {
  const Eigen::Matrix3d& k = calibration_.camera_matrix;
  const double y = (pixel.y() - k(1, 2)) / k(1, 1);
  return {(pixel.x() - k(0, 2) - k(0, 1) * y) / k(0, 0), y};
}

std::optional<Eigen::Vector2d> CameraModel::NormalisedFromPixel(const Eigen::Vector2d& pixel) const {
  return lens_->Undistort(DistortedFromPixel(pixel), max_radius_);
}

std::optional<Eigen::Vector2d> CameraModel::NormalisedFromPixel(const Eigen::Vector2d& pixel,
                                                                const Eigen::Vector2d& nearby) const {
  const Eigen::Vector2d distorted = DistortedFromPixel(pixel);
  const std::optional<Eigen::Vector2d> found = lens_->UndistortNear(distorted, nearby, max_radius_);
  return found ? found : lens_->Undistort(distorted, max_radius_);
}

double CameraModel::PixelStretch(double radius) const {
  const auto bin = static_cast<int>(std::min(std::max(radius, 0.0) / max_radius_, 1.0) * kStretchBins);
  return stretch_px_[static_cast<std::size_t>(std::min(bin, kStretchBins - 1))];
}

}  // namespace elbowroom::core
