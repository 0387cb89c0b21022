// What one question to a camera costs: the volume query asks it of every camera, millions of times a second.
#include <benchmark/benchmark.h>

#include <Eigen/Core>
#include <random>
#include <vector>

#include "core/camera_model.h"

namespace elbowroom::core {
namespace {

CameraModel MakeCamera(DistortionModel model, std::vector<double> coefficients) {
  CameraCalibration calibration;
  calibration.name = "bench";
  calibration.image_width_px = 640;
  calibration.image_height_px = 480;
  calibration.camera_matrix << 500.0, 0.0, 319.5, 0.0, 500.0, 239.5, 0.0, 0.0, 1.0;
  calibration.distortion_model = model;
  calibration.distortion_coefficients = std::move(coefficients);
  return CameraModel(calibration);
}

CameraModel PlumbBob() { return MakeCamera(DistortionModel::kPlumbBob, {-0.2, 0.05, 0.001, -0.001, 0.0}); }
CameraModel Fisheye() { return MakeCamera(DistortionModel::kFisheye, {0.01, -0.005, 0.001, 0.0}); }

std::vector<Eigen::Vector3d> PointsInViewInCam() {
  constexpr std::size_t kPoints = 4096;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> sideways(-0.5, 0.5), depth_mm(500.0, 3000.0);
  std::vector<Eigen::Vector3d> points;
  while (points.size() < kPoints) {
    points.push_back(depth_mm(random) * Eigen::Vector3d(sideways(random), sideways(random), 1.0));
  }
  return points;
}

void Project(benchmark::State& state, const CameraModel& camera) {
  const std::vector<Eigen::Vector3d> points = PointsInViewInCam();
  for (auto _ : state) {
    for (const Eigen::Vector3d& x_in_cam : points) benchmark::DoNotOptimize(camera.ProjectInCam(x_in_cam));
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(points.size()));
}
BENCHMARK_CAPTURE(Project, plumb_bob, PlumbBob());
BENCHMARK_CAPTURE(Project, fisheye, Fisheye());

void Unproject(benchmark::State& state, const CameraModel& camera) {
  std::int64_t pixels = 0;
  for (auto _ : state) {
    for (int x = 0; x < camera.width_px(); x += 16) {
      benchmark::DoNotOptimize(camera.NormalisedFromPixel({x, 100.0}));
      ++pixels;
    }
  }
  state.SetItemsProcessed(pixels);
}
BENCHMARK_CAPTURE(Unproject, plumb_bob, PlumbBob());
BENCHMARK_CAPTURE(Unproject, fisheye, Fisheye());

}  // namespace
}  // namespace elbowroom::core
