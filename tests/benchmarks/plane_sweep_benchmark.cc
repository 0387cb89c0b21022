// What a view by the paper's plane sweep costs, masks in memory to depths in memory: 640 x 480, the demo's
// hand in about 6 % of it, 50 planes. The CPU's argument is the number of threads.
#include <benchmark/benchmark.h>
#include <tbb/global_control.h>

#include "recon/gl/paper_methods/plane_sweep_gl.h"
#include "recon/paper_methods/plane_sweep.h"
#include "recon/synthetic/view_scene.h"

namespace elbowroom::benchmarks {
namespace {

using recon::ViewSceneRig;

struct SweepScene {
  recon::ViewScene scene;
  std::vector<core::SoftMask> masks;
  recon::SweepRays rays;
};

SweepScene SceneOf(ViewSceneRig rig) {
  recon::ViewScene scene = recon::MakeViewScene(rig);
  std::vector<core::SoftMask> masks = recon::TrueMasks(scene.rig, scene.objects);
  recon::SweepRays rays(scene.view);
  return {std::move(scene), std::move(masks), std::move(rays)};
}

void Report(benchmark::State& state, const recon::SweptView& swept) {
  state.counters["planes"] = static_cast<double>(swept.stats.planes);
  state.counters["hit_pixels"] = static_cast<double>(swept.picture.hit_pixels);
  state.counters["tested_points"] = static_cast<double>(swept.stats.tested_points);
}

void SweepOnCpu(benchmark::State& state, ViewSceneRig rig, int grid) {
  const auto [scene, masks, rays] = SceneOf(rig);
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                  static_cast<std::size_t>(state.range(0)));
  recon::PlaneSweepOptions options = recon::FiftyPlanes();
  options.undistortion_grid = grid;
  recon::SweptView swept;
  for (auto _ : state) {
    swept = recon::SweepPlanes(scene.rig, masks, scene.view, rays, options);
    benchmark::DoNotOptimize(swept);
  }
  Report(state, swept);
}

void SweepOnGl(benchmark::State& state, ViewSceneRig rig, recon::gl::SweepPasses passes, int grid) {
  const auto [scene, masks, rays] = SceneOf(rig);
  recon::PlaneSweepOptions options = recon::FiftyPlanes();
  options.undistortion_grid = grid;
  recon::gl::PlaneSweepGl sweep;
  // The first sweep compiles the shaders.
  recon::SweptView swept = sweep.Sweep(scene.rig, masks, scene.view, rays, options, passes);
  for (auto _ : state) {
    swept = sweep.Sweep(scene.rig, masks, scene.view, rays, options, passes);
    benchmark::DoNotOptimize(swept);
  }
  Report(state, swept);
  state.SetLabel(sweep.driver());
}

#define ON_CPU(rig, of_rig)                                 \
  BENCHMARK_CAPTURE(SweepOnCpu, rig##_lens, of_rig, 0)      \
      ->Arg(1)                                              \
      ->Arg(2)                                              \
      ->Unit(benchmark::kMillisecond)                       \
      ->UseRealTime();                                      \
  BENCHMARK_CAPTURE(SweepOnCpu, rig##_grid_of_5, of_rig, 5) \
      ->Arg(1)                                              \
      ->Arg(2)                                              \
      ->Unit(benchmark::kMillisecond)                       \
      ->UseRealTime()
#define ON_GL(rig, of_rig)                                                                          \
  BENCHMARK_CAPTURE(SweepOnGl, rig##_a_draw_a_plane, of_rig, recon::gl::SweepPasses::kOneAPlane, 0) \
      ->Unit(benchmark::kMillisecond)                                                               \
      ->UseRealTime();                                                                              \
  BENCHMARK_CAPTURE(SweepOnGl, rig##_the_papers_passes_and_grid, of_rig,                            \
                    recon::gl::SweepPasses::kOneAPlaneAndCamera, 5)                                 \
      ->Unit(benchmark::kMillisecond)                                                               \
      ->UseRealTime()
ON_CPU(three_cameras, ViewSceneRig::kThree);
ON_CPU(eight_cameras, ViewSceneRig::kEight);
ON_GL(three_cameras, ViewSceneRig::kThree);
ON_GL(eight_cameras, ViewSceneRig::kEight);
#undef ON_CPU
#undef ON_GL

}  // namespace
}  // namespace elbowroom::benchmarks
