// What a view by the paper's plane sweep costs, masks in memory to depths in memory: 640 x 480, the demo's
// hand in about 6 % of it, 50 planes. Arguments: cameras, and threads on the CPU.
#include <benchmark/benchmark.h>
#include <tbb/global_control.h>

#include "recon/gl/plane_sweep_gl.h"
#include "recon/plane_sweep.h"
#include "tests/benchmarks/hand_scene.h"

namespace elbowroom::benchmarks {
namespace {

// 50 planes at the paper's 15 mm, around the hand.
recon::PlaneSweepOptions FiftyPlanes() {
  recon::PlaneSweepOptions options;
  options.near_mm = 780.0;
  options.far_mm = options.near_mm + 49.0 * options.spacing_mm;
  return options;
}

void Report(benchmark::State& state, const recon::SweptView& swept) {
  state.counters["planes"] = static_cast<double>(swept.stats.planes);
  state.counters["hit_pixels"] = static_cast<double>(swept.picture.hit_pixels);
  state.counters["tested_points"] = static_cast<double>(swept.stats.tested_points);
}

void SweepOnCpu(benchmark::State& state, int grid) {
  const HandScene scene = MakeHandScene(static_cast<int>(state.range(0)));
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                  static_cast<std::size_t>(state.range(1)));
  const recon::SweepRays rays(scene.view);
  recon::PlaneSweepOptions options = FiftyPlanes();
  options.undistortion_grid = grid;
  recon::SweptView swept;
  for (auto _ : state) {
    swept = recon::SweepPlanes(scene.rig, scene.masks, scene.view, rays, options);
    benchmark::DoNotOptimize(swept);
  }
  Report(state, swept);
}

void SweepOnGl(benchmark::State& state, recon::gl::SweepPasses passes, int grid) {
  const HandScene scene = MakeHandScene(static_cast<int>(state.range(0)));
  const recon::SweepRays rays(scene.view);
  recon::PlaneSweepOptions options = FiftyPlanes();
  options.undistortion_grid = grid;
  recon::gl::PlaneSweepGl sweep;
  // The first sweep compiles the shaders.
  recon::SweptView swept = sweep.Sweep(scene.rig, scene.masks, scene.view, rays, options, passes);
  for (auto _ : state) {
    swept = sweep.Sweep(scene.rig, scene.masks, scene.view, rays, options, passes);
    benchmark::DoNotOptimize(swept);
  }
  Report(state, swept);
  state.SetLabel(sweep.driver());
}

BENCHMARK_CAPTURE(SweepOnCpu, lens, 0)
    ->ArgNames({"cameras", "threads"})
    ->ArgsProduct({{3, 4, 8}, {1, 2}})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(SweepOnCpu, grid_of_5, 5)
    ->ArgNames({"cameras", "threads"})
    ->ArgsProduct({{3, 4, 8}, {1, 2}})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(SweepOnGl, a_draw_a_plane, recon::gl::SweepPasses::kOneAPlane, 0)
    ->ArgName("cameras")
    ->DenseRange(3, 4)
    ->Arg(8)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(SweepOnGl, the_papers_passes_and_grid, recon::gl::SweepPasses::kOneAPlaneAndCamera, 5)
    ->ArgName("cameras")
    ->DenseRange(3, 4)
    ->Arg(8)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

}  // namespace
}  // namespace elbowroom::benchmarks
