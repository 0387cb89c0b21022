// Exact views of the demo's hand: from masks in memory to a 640 x 480 depth picture.
#include <benchmark/benchmark.h>
#include <tbb/global_control.h>

#include <memory>

#include "recon/hull_view.h"
#include "tests/benchmarks/hand_scene.h"

namespace elbowroom::recon {
namespace {

void ExactView(benchmark::State& state) {
  const benchmarks::HandScene scene = benchmarks::MakeHandScene(static_cast<int>(state.range(0)));
  const auto rig = std::make_shared<const core::Rig>(scene.rig);
  const tbb::global_control threads(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(state.range(1)));
  const PicturePlanes planes = MakePicturePlanes(*rig);
  const ViewRays rays(scene.view);
  HullViewOptions options;
  options.surfaces = options.normals = false;
  HullView view;
  for (auto _ : state) {
    view = ViewHull(MakeVisualHull(rig, planes, scene.masks), rays, options);
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
