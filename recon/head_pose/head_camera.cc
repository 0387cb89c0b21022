#include "recon/head_pose/head_camera.h"

#include <Eigen/Dense>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.h"

namespace elbowroom::recon {
namespace {

using Eigen::AngleAxisd;
using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double kMostFocalPx = 1e5;
constexpr int kMostSidePx = 16384;
constexpr int kMostSteps = 200;
constexpr double kStill = 1e-12;  // of the sum of squares: it doesn't sink any more

// What a fit changes: turns about the camera's x, y, z (rad), the logarithm of the focal length, its place
// (mm).
using Change = Eigen::Matrix<double, 7, 1>;
enum Number { kTurnX, kTurnY, kTurnZ, kFocal, kPlace };

std::vector<int> NumbersFor(std::size_t points) {
  if (points == 1) return {kTurnX, kTurnY};
  if (points == 2) return {kTurnX, kTurnY, kTurnZ, kFocal};
  if (points == 3) return {kTurnX, kTurnY, kTurnZ, kPlace, kPlace + 1, kPlace + 2};
  return {kTurnX, kTurnY, kTurnZ, kFocal, kPlace, kPlace + 1, kPlace + 2};
}

HeadCamera Changed(HeadCamera camera, const Change& by) {
  const Vector3d turn = by.head<3>();
  if (turn.norm() > 0.0)
    camera.head_from_camera.rotation *= AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix();
  camera.head_from_camera.translation_mm += camera.head_from_camera.rotation * by.tail<3>();
  camera.focal_px *= std::exp(by[kFocal]);
  return camera;
}

VectorXd ResidualsOf(const HeadCamera& camera, std::span<const SeenPoint> points) {
  VectorXd residuals(2 * static_cast<Eigen::Index>(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i)
    residuals.segment<2>(2 * static_cast<Eigen::Index>(i)) =
        PixelOf(camera, points[i].x_in_head) - points[i].pixel;
  return residuals;
}

// By differences of both sides; steps that move a point by some thousandths of a pixel.
Eigen::MatrixXd DerivativesOf(const HeadCamera& camera, std::span<const SeenPoint> points,
                              const std::vector<int>& numbers) {
  constexpr double kTurnStep = 1e-6, kPlaceStepMm = 1e-3;
  Eigen::MatrixXd derivatives(2 * static_cast<Eigen::Index>(points.size()),
                              static_cast<Eigen::Index>(numbers.size()));
  for (std::size_t k = 0; k < numbers.size(); ++k) {
    Change step = Change::Zero();
    step[numbers[k]] = numbers[k] < kPlace ? kTurnStep : kPlaceStepMm;
    derivatives.col(static_cast<Eigen::Index>(k)) =
        (ResidualsOf(Changed(camera, step), points) - ResidualsOf(Changed(camera, -step), points)) /
        (2.0 * step[numbers[k]]);
  }
  return derivatives;
}

HeadCamera Descend(HeadCamera camera, std::span<const SeenPoint> points, const std::vector<int>& numbers) {
  double damping = 1e-3;
  VectorXd residuals = ResidualsOf(camera, points);
  for (int step = 0; step < kMostSteps && damping < 1e12; ++step) {
    const Eigen::MatrixXd derivatives = DerivativesOf(camera, points, numbers);
    Eigen::MatrixXd normal = derivatives.transpose() * derivatives;
    normal.diagonal() *= 1.0 + damping;
    normal.diagonal().array() += 1e-12 * normal.diagonal().maxCoeff();
    const VectorXd solved = normal.ldlt().solve(-derivatives.transpose() * residuals);
    Change by = Change::Zero();
    for (std::size_t k = 0; k < numbers.size(); ++k) by[numbers[k]] = solved[static_cast<Eigen::Index>(k)];
    const HeadCamera next = Changed(camera, by);
    const VectorXd there = ResidualsOf(next, points);
    const bool is_better = next.focal_px <= kMostFocalPx && there.squaredNorm() <= residuals.squaredNorm();
    damping *= is_better ? 0.2 : 8.0;
    if (!is_better) continue;
    const double gained = residuals.squaredNorm() - there.squaredNorm();
    camera = next;
    residuals = there;
    if (gained <= kStill * (1.0 + residuals.squaredNorm())) break;
  }
  return camera;
}

}  // namespace

void HeadCamera::Validate() const {
  core::Require(width_px > 0 && height_px > 0 && width_px <= kMostSidePx && height_px <= kMostSidePx,
                "a head camera's picture has pixels");
  core::Require(focal_px > 0.0 && focal_px <= kMostFocalPx, "a head camera's focal_px lies within (0, 1e5]");
  core::Require(core::IsRotation(head_from_camera.rotation) && head_from_camera.translation_mm.allFinite(),
                "a head camera stands somewhere");
}

core::CameraModel HeadCamera::ModelFor(const core::RigidTransform& world_from_head) const {
  core::CameraCalibration calibration;
  calibration.name = "head camera";
  calibration.image_width_px = width_px;
  calibration.image_height_px = height_px;
  calibration.camera_matrix << focal_px, 0.0, 0.5 * (width_px - 1), 0.0, focal_px, 0.5 * (height_px - 1), 0.0,
      0.0, 1.0;
  calibration.cam_from_world = (world_from_head * head_from_camera).Inverse();
  return core::CameraModel(std::move(calibration));
}

HeadCamera ResizedTo(const HeadCamera& camera, int width_px, int height_px) {
  HeadCamera resized = camera;
  resized.focal_px *= static_cast<double>(width_px) / camera.width_px;
  resized.width_px = width_px;
  resized.height_px = height_px;
  resized.Validate();
  return resized;
}

Vector2d PixelOf(const HeadCamera& camera, const Vector3d& x_in_head) {
  const Vector3d x = camera.head_from_camera.Inverse() * x_in_head;
  if (!(x.z() > 0.0)) return Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());
  return camera.focal_px / x.z() * x.head<2>() +
         0.5 * Vector2d(camera.width_px - 1.0, camera.height_px - 1.0);
}

HeadCameraFit FitHeadCamera(const HeadCamera& start, std::span<const SeenPoint> points) {
  start.Validate();
  if (points.empty())
    throw core::Error(core::ErrorKind::kRange, "mark a point of a part and its place first");
  if (!ResidualsOf(start, points).allFinite())
    throw core::Error(core::ErrorKind::kRange,
                      "a marked point lies behind the camera: turn the camera by hand first");
  const std::vector<int> numbers = NumbersFor(points.size());
  HeadCameraFit fit;
  fit.camera = Descend(start, points, numbers);
  fit.camera.head_from_camera.rotation =
      Eigen::Quaterniond(fit.camera.head_from_camera.rotation).normalized().toRotationMatrix();
  fit.fitted = static_cast<int>(numbers.size());
  const VectorXd residuals = ResidualsOf(fit.camera, points);
  for (std::size_t i = 0; i < points.size(); ++i)
    fit.residuals_px.push_back(residuals.segment<2>(2 * static_cast<Eigen::Index>(i)).norm());
  fit.rms_px = std::sqrt(residuals.squaredNorm() / static_cast<double>(points.size()));
  return fit;
}

// What is straight on goes to the right when the camera turns to the left, about -y.
HeadCamera Turned(const HeadCamera& camera, const Vector2d& by_px) {
  HeadCamera turned = camera;
  turned.head_from_camera.rotation *=
      (AngleAxisd(-std::atan(by_px.x() / camera.focal_px), Vector3d::UnitY()) *
       AngleAxisd(std::atan(by_px.y() / camera.focal_px), Vector3d::UnitX()))
          .toRotationMatrix();
  return turned;
}

// z points away from the viewer: a positive turn is clockwise in the picture, and the camera turns the other
// way.
HeadCamera Rolled(const HeadCamera& camera, double clockwise_rad) {
  HeadCamera rolled = camera;
  rolled.head_from_camera.rotation *= AngleAxisd(-clockwise_rad, Vector3d::UnitZ()).toRotationMatrix();
  return rolled;
}

HeadCamera Moved(const HeadCamera& camera, const Vector3d& by_mm) {
  HeadCamera moved = camera;
  moved.head_from_camera.translation_mm += camera.head_from_camera.rotation * by_mm;
  return moved;
}

HeadCamera Scaled(const HeadCamera& camera, double by) {
  HeadCamera scaled = camera;
  scaled.focal_px = std::clamp(camera.focal_px * by, 1.0, kMostFocalPx);
  return scaled;
}

}  // namespace elbowroom::recon
