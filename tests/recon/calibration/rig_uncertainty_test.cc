// The stated uncertainty of points against many draws of rigs and pixels.
#include "recon/calibration/rig_uncertainty.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <chrono>
#include <cmath>
#include <cstdio>

#include "core/error.h"
#include "recon/calibration/calibrate.h"
#include "recon/calibration/rotation.h"
#include "recon/calibration/triangulation.h"
#include "tests/recon/calibration/calibration_scene.h"

namespace elbowroom::recon {
namespace {

using Eigen::Vector3d;

const CalibrationResult& FourCameras() {
  static const CalibrationResult result = [] {
    CalibrationSceneOptions options = StillBoardOptions();
    options.runs = 25;
    options.has_plain_lenses = true;
    return Calibrate(MakeCalibrationScene(options, 1).input);
  }();
  return result;
}

double NormalDraw(Random* random) {
  double sum = 0.0;
  for (int i = 0; i < 12; ++i) sum += random->Uniform(-0.5, 0.5);
  return sum;
}

TEST(RigUncertainty, IsThatOfManyDraws) {
  constexpr int kDraws = 2000;
  const CalibrationResult& result = FourCameras();
  const Vector3d x(150.0, -100.0, 80.0);
  const RigUncertainty rig(result, 0.5);
  const PointUncertainty stated = rig.At(x).value();
  const Eigen::Index count = result.covariance.rows();
  const Eigen::MatrixXd jitter = 1e-24 * Eigen::MatrixXd::Identity(count, count);
  const Eigen::MatrixXd root = Eigen::LLT<Eigen::MatrixXd>(result.covariance + jitter).matrixL();
  ASSERT_EQ(stated.cameras, static_cast<int>(result.cameras.size()));
  Random random(2);
  double chi2 = 0.0;
  for (int draw = 0; draw < kDraws; ++draw) {
    Eigen::VectorXd normal(count);
    for (Eigen::Index i = 0; i < count; ++i) normal[i] = NormalDraw(&random);
    const Eigen::VectorXd change = root * normal;
    std::vector<LensParameters> lenses;
    std::vector<PointSight> sights;
    for (const CalibratedCamera& camera : result.cameras)
      lenses.push_back(LensParametersOf(camera.calibration));
    for (std::size_t i = 0; i < lenses.size(); ++i) {
      const ParameterBlock& block = result.cameras[i].parameters;
      core::RigidTransform cam_from_world = result.cameras[i].calibration.cam_from_world;
      const Eigen::Vector2d pixel = ProjectPoint(lenses[i], cam_from_world * x).value() +
                                    0.5 * Eigen::Vector2d(NormalDraw(&random), NormalDraw(&random));
      lenses[i].values += change.segment(block.first, block.intrinsics);
      cam_from_world.rotation =
          RotationFromVector(change.segment<3>(block.rotation())) * cam_from_world.rotation;
      cam_from_world.translation_mm += change.segment<3>(block.translation());
      sights.push_back({&lenses[i], cam_from_world, pixel});
    }
    const Vector3d error = Triangulate(sights).value() - x;
    chi2 += error.dot(stated.covariance_mm2.inverse() * error) / kDraws;
  }
  EXPECT_NEAR(chi2, 3.0, 4.0 * std::sqrt(6.0 / kDraws));
}

TEST(RigUncertainty, PointsThatOneCameraSeesHaveNone) {
  const CalibrationResult& result = FourCameras();
  const RigUncertainty rig(result, 0.3);
  // Just before the first camera, where no other looks.
  const core::RigidTransform world_from_cam = result.cameras[0].calibration.cam_from_world.Inverse();
  const Vector3d near = world_from_cam * Vector3d(0.0, 0.0, 30.0);
  EXPECT_EQ(rig.CamerasSeeing(near), 1);
  EXPECT_FALSE(rig.At(near));
  const Vector3d away = world_from_cam * Vector3d(0.0, 0.0, -5000.0);
  EXPECT_EQ(rig.CamerasSeeing(away), 0);
  EXPECT_FALSE(rig.At(away));
}

TEST(RigUncertainty, MoreNoiseIsMoreUncertainty) {
  const Vector3d x(0.0, 0.0, 50.0);
  const double little = RigUncertainty(FourCameras(), 0.1).At(x).value().sigma_mm();
  const double much = RigUncertainty(FourCameras(), 1.0).At(x).value().sigma_mm();
  EXPECT_GT(little, 0.0);
  EXPECT_GT(much, 3.0 * little);
}

TEST(RigUncertainty, OfARigFileIsThatOfItsCalibration) {
  const CalibrationResult& result = FourCameras();
  std::vector<core::CameraModel> cameras;
  for (const CalibratedCamera& camera : result.cameras) cameras.emplace_back(camera.calibration);
  const Vector3d x(0.0, 0.0, 50.0);
  const Eigen::Matrix3d stated = RigUncertainty(result, 0.3).At(x).value().covariance_mm2;
  EXPECT_EQ(RigUncertainty(cameras, result.covariance, 0.3).At(x).value().covariance_mm2, stated);
  // Exact cameras leave the noise of the pixels.
  const Eigen::Matrix3d exact = RigUncertainty(cameras, {}, 0.3).At(x).value().covariance_mm2;
  EXPECT_GT(exact.trace(), 0.0);
  EXPECT_GT((stated - exact).eval().selfadjointView<Eigen::Lower>().eigenvalues().minCoeff(), -1e-9);
}

TEST(UncertaintyMap, HoldsWhatEachNodeHas) {
  const RigUncertainty rig(FourCameras(), 0.3);
  const Eigen::AlignedBox3d box(Vector3d(-300.0, -200.0, 0.0), Vector3d(300.0, 210.0, 100.0));
  const UncertaintyMap map = MapUncertainty(rig, box, 100.0);
  EXPECT_EQ(map.nodes, Eigen::Vector3i(7, 5, 2));
  ASSERT_EQ(map.values.size(), 70U);
  std::size_t place = 0;
  for (int z = 0; z < 2; ++z) {
    for (int y = 0; y < 5; ++y) {
      for (int x = 0; x < 7; ++x, ++place) {
        const auto at = rig.At(box.min() + 100.0 * Vector3d(x, y, z));
        EXPECT_EQ(map.values[place].is_known, at.has_value());
        EXPECT_FLOAT_EQ(map.values[place].sigma_mm, at ? static_cast<float>(at->sigma_mm()) : 0.0F);
      }
    }
  }
}

TEST(UncertaintyMap, OfACubicMetreIsQuick) {
  const RigUncertainty rig(FourCameras(), 0.3);
  const Eigen::AlignedBox3d box(Vector3d(-500.0, -500.0, 0.0), Vector3d(500.0, 500.0, 1000.0));
  const auto start = std::chrono::steady_clock::now();
  const UncertaintyMap map = MapUncertainty(rig, box, 20.0);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  EXPECT_EQ(map.values.size(), 132651U);
  std::printf("%zu nodes in %.2f s\n", map.values.size(), seconds);
  // 1 s is what two free cores are to take; a loaded machine, or one with checks built in, takes longer.
  EXPECT_LE(seconds, 20.0);
}

TEST(UncertaintyMap, StopsWhenAsked) {
  const RigUncertainty rig(FourCameras(), 0.3);
  std::stop_source source;
  source.request_stop();
  EXPECT_THROW((void)MapUncertainty(rig, {Vector3d::Zero(), Vector3d::Ones()}, 0.5, {}, source.get_token()),
               core::Error);
  EXPECT_THROW((void)MapUncertainty(rig, {Vector3d::Zero(), Vector3d::Ones()}, 0.0), core::PreconditionError);
}

}  // namespace
}  // namespace elbowroom::recon
