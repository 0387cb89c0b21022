// The lens's formulas are core::CameraModel's, and their derivatives are those of differences.
#include <gtest/gtest.h>

#include "recon/calibration/lens_projection.h"
#include "tests/recon/calibration/calibration_scene.h"

namespace elbowroom::recon {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

std::vector<core::CameraCalibration> ManyCameras() {
  CalibrationSceneOptions options;
  options.cameras = 8;
  options.runs = 1;
  std::vector<core::CameraCalibration> cameras;
  for (std::uint64_t seed = 0; seed < 10; ++seed)
    for (const auto& camera : MakeCalibrationScene(options, seed).cameras) cameras.push_back(camera);
  // With prism terms and skew, as a lens that is kept may have.
  core::CameraCalibration prism = cameras.front();
  prism.distortion_model = core::DistortionModel::kRationalPolynomial;
  prism.distortion_coefficients = {-0.1, 0.02, 1e-3, -1e-3, 0.01, 0.1, 0.02, 0.01, 1e-3, -1e-3, 2e-3, 1e-3};
  prism.camera_matrix(0, 1) = 0.7;
  cameras.push_back(prism);
  return cameras;
}

Vector3d PointInPicture(const core::CameraModel& model, Random* random) {
  const auto normalised = model.NormalisedFromPixel(
      {random->Uniform(0.0, model.width_px() - 1.0), random->Uniform(0.0, model.height_px() - 1.0)});
  return random->Uniform(500.0, 3000.0) * normalised.value_or(Vector2d::Zero()).homogeneous();
}

TEST(LensProjection, IsThatOfTheCameraModel) {
  Random random(1);
  for (const core::CameraCalibration& camera : ManyCameras()) {
    const core::CameraModel model(camera);
    const LensParameters lens = LensParametersOf(camera);
    for (int i = 0; i < 100; ++i) {
      const Vector3d x_in_cam = PointInPicture(model, &random);
      const Vector2d expected = model.ProjectInCam(x_in_cam).value();
      EXPECT_LE((ProjectPoint(lens, x_in_cam).value() - expected).norm(), 1e-9);
      EXPECT_LE((ProjectWithDerivatives(lens, x_in_cam).value().pixel - expected).norm(), 1e-9);
      const auto normalised = NormalisedPoint(lens, expected);
      ASSERT_TRUE(normalised);
      EXPECT_LE((*normalised - x_in_cam.head<2>() / x_in_cam.z()).norm(), 1e-8);
    }
  }
}

TEST(LensProjection, IsNothingBehindTheCamera) {
  const LensParameters lens = LensParametersOf(ManyCameras().front());
  EXPECT_FALSE(ProjectPoint(lens, {0.0, 0.0, 0.0}));
  EXPECT_FALSE(ProjectPoint(lens, {1.0, 2.0, -5.0}));
  EXPECT_FALSE(ProjectWithDerivatives(lens, {1.0, 2.0, -5.0}));
}

TEST(LensProjection, DerivativesAreThoseOfDifferences) {
  // Central differences: the error is of the order of step^2 and of rounding over step.
  constexpr double kStep = 1e-5, kTolerance = 2e-6;
  Random random(2);
  for (const core::CameraCalibration& camera : ManyCameras()) {
    const core::CameraModel model(camera);
    const LensParameters lens = LensParametersOf(camera);
    for (int i = 0; i < 10; ++i) {
      const Vector3d x = PointInPicture(model, &random);
      const ProjectedPoint point = ProjectWithDerivatives(lens, x).value();
      for (int j = 0; j < 3; ++j) {
        const Vector3d step = 1000.0 * kStep * Vector3d::Unit(j);  // mm
        const Vector2d slope =
            (ProjectPoint(lens, x + step).value() - ProjectPoint(lens, x - step).value()) / (2000.0 * kStep);
        EXPECT_LE((point.by_x_in_cam.col(j) - slope).norm(), kTolerance * (1.0 + slope.norm()));
      }
      for (int j = 0; j < lens.count(); ++j) {
        LensParameters more = lens, less = lens;
        more.values[j] += kStep;
        less.values[j] -= kStep;
        const Vector2d slope =
            (ProjectPoint(more, x).value() - ProjectPoint(less, x).value()) / (2.0 * kStep);
        EXPECT_LE((point.by_values.col(j) - slope).norm(), kTolerance * (1.0 + slope.norm()))
            << "value " << j;
      }
    }
  }
}

}  // namespace
}  // namespace elbowroom::recon
