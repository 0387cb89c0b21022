// Exact views of the demo's hand: from masks in memory to a 640 x 480 depth picture.
#include <benchmark/benchmark.h>
#include <tbb/global_control.h>

#include <memory>
#include <vector>

#include "core/rig.h"
#include "recon/hull_view.h"
#include "recon/synthetic/demo_motion.h"
#include "recon/synthetic/rig_presets.h"
#include "recon/synthetic/synthetic_rig.h"

namespace elbowroom::recon {
namespace {

constexpr double kTimeS = 4.0;

core::CameraModel View(const core::Rig& rig, double focal_px) {
  (void)rig;
  core::CameraCalibration calibration;
  calibration.name = "view";
  calibration.image_width_px = 640, calibration.image_height_px = 480;
  calibration.camera_matrix << focal_px, 0.0, 319.5, 0.0, focal_px, 239.5, 0.0, 0.0, 1.0;
  calibration.cam_from_world = core::CamFromWorldLookingAt({-700.0, -900.0, 500.0}, {0.0, 0.0, 150.0});
  return core::CameraModel(calibration);
}

core::Rig RigOf(int cameras) {
  if (cameras == 8) return EightCameraRig();
  core::Rig rig = FourCameraRig();
  rig.cameras.erase(rig.cameras.begin() + cameras, rig.cameras.end());
  return rig;
}

void ExactView(benchmark::State& state) {
  const auto rig = std::make_shared<const core::Rig>(RigOf(static_cast<int>(state.range(0))));
  const tbb::global_control threads(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(state.range(1)));
  SyntheticRig synthetic(*rig, [](double time_s) { return DemoSceneAt(time_s).objects; });
  const std::vector<SyntheticObject> objects = DemoSceneAt(kTimeS).objects;
  std::vector<core::SoftMask> masks;
  for (core::BitMask& mask : synthetic.TrueMasks(objects)) masks.push_back({std::move(mask), {}});
  const PicturePlanes planes = MakePicturePlanes(*rig);
  const ViewRays rays(View(*rig, 1000.0));
  HullViewOptions options;
  options.surfaces = options.normals = false;
  HullView view;
  for (auto _ : state) {
    view = ViewHull(MakeVisualHull(rig, planes, masks), rays, options);
    benchmark::DoNotOptimize(view.depth_mm.data());
  }
  state.counters["hit_pixels"] = static_cast<double>(view.hit_pixels);
  state.counters["hit_share"] = static_cast<double>(view.hit_pixels) / (640.0 * 480.0);
  state.counters["cast_pixels"] = static_cast<double>(view.cast_pixels);
  state.counters["edges"] = static_cast<double>(view.edges);
  state.counters["edges_met"] = static_cast<double>(view.edges_met);
}
BENCHMARK(ExactView)
    ->ArgNames({"cameras", "threads"})
    ->ArgsProduct({{3, 4, 8}, {1, 2}})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

}  // namespace
}  // namespace elbowroom::recon
