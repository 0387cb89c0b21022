// Masks in memory to a picture of the hull, and the steps on the way.
#include <benchmark/benchmark.h>
#include <tbb/global_control.h>

#include <map>
#include <memory>

#include "recon/hull_mesh.h"
#include "recon/ray_cast.h"
#include "recon/synthetic/view_scene.h"
#include "recon/visual_hull.h"

namespace elbowroom::recon {
namespace {

struct MaskScene {
  std::shared_ptr<const core::Rig> rig;
  std::vector<core::BitMask> masks;
  core::CameraModel view;
};

const MaskScene& SceneOf(ViewSceneRig rig) {
  static std::map<ViewSceneRig, MaskScene> scenes;
  const auto found = scenes.find(rig);
  if (found != scenes.end()) return found->second;
  const ViewScene scene = MakeViewScene(rig);
  MaskScene made{std::make_shared<const core::Rig>(scene.rig), TrueMasks(scene.rig, scene.objects),
                 scene.view};
  return scenes.emplace(rig, std::move(made)).first->second;
}

// The benchmark's argument is the number of threads.
tbb::global_control Limit(const benchmark::State& state) {
  return {tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(state.range(0))};
}

void ExactView(benchmark::State& state, ViewSceneRig rig) {
  const MaskScene& scene = SceneOf(rig);
  const auto limit = Limit(state);
  for (auto _ : state)
    benchmark::DoNotOptimize(ViewHull(MakeVisualHull(scene.rig, scene.masks), scene.view).hit_pixels);
}

void HullOfMasks(benchmark::State& state, ViewSceneRig rig) {
  const MaskScene& scene = SceneOf(rig);
  const auto limit = Limit(state);
  for (auto _ : state) benchmark::DoNotOptimize(MakeVisualHull(scene.rig, scene.masks).IsEmpty());
}

void MeshAt2Mm(benchmark::State& state, ViewSceneRig rig) {
  const MaskScene& scene = SceneOf(rig);
  const VisualHull hull = MakeVisualHull(scene.rig, scene.masks);
  const auto limit = Limit(state);
  for (auto _ : state) benchmark::DoNotOptimize(MeshHull(hull, 2.0).cells);
}

#define ON_EVERY_RIG(what)                                                                             \
  BENCHMARK_CAPTURE(what, three_cameras, ViewSceneRig::kThree)                                         \
      ->Arg(1)                                                                                         \
      ->Arg(2)                                                                                         \
      ->Unit(benchmark::kMillisecond);                                                                 \
  BENCHMARK_CAPTURE(what, paper, ViewSceneRig::kPaper)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond); \
  BENCHMARK_CAPTURE(what, eight_cameras, ViewSceneRig::kEight)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)
ON_EVERY_RIG(ExactView);
ON_EVERY_RIG(HullOfMasks);
ON_EVERY_RIG(MeshAt2Mm);
#undef ON_EVERY_RIG

}  // namespace
}  // namespace elbowroom::recon
