// Masks in memory to a picture of the hull, and the steps on the way.
#include <benchmark/benchmark.h>
#include <tbb/global_control.h>

#include <map>
#include <memory>

#include "recon/contours/undistorted_plane.h"
#include "recon/exact_view/hull_view.h"
#include "recon/hull/visual_hull.h"
#include "recon/hull_mesh/hull_mesh.h"
#include "recon/synthetic/view_scene.h"

namespace elbowroom::recon {
namespace {

struct MaskScene {
  std::shared_ptr<const core::Rig> rig;
  UndistortedPlanes planes;
  std::vector<core::SoftMask> masks;
  ViewRays view;

  [[nodiscard]] VisualHull Hull() const { return MakeVisualHull(rig, planes, masks); }
};

const MaskScene& SceneOf(ViewSceneRig rig) {
  static std::map<ViewSceneRig, MaskScene> scenes;
  const auto found = scenes.find(rig);
  if (found != scenes.end()) return found->second;
  const ViewScene scene = MakeViewScene(rig);
  MaskScene made{std::make_shared<const core::Rig>(scene.rig), MakeUndistortedPlanes(scene.rig),
                 TrueMasks(scene.rig, scene.objects), ViewRays(scene.view)};
  return scenes.emplace(rig, std::move(made)).first->second;
}

// The benchmark's argument is the number of threads.
tbb::global_control Limit(const benchmark::State& state) {
  return {tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(state.range(0))};
}

void ExactView(benchmark::State& state, ViewSceneRig rig) {
  const MaskScene& scene = SceneOf(rig);
  const auto limit = Limit(state);
  HullView view;
  for (auto _ : state) {
    view = ViewHull(scene.Hull(), scene.view, {.surfaces = false, .normals = false});
    benchmark::DoNotOptimize(view);
  }
  state.counters["hit_pixels"] = static_cast<double>(view.hit_pixels);
  state.counters["cast_pixels"] = static_cast<double>(view.cast_pixels);
  state.counters["crossings_met"] = static_cast<double>(view.crossings_met);
}

// As the console has it made: normals too, of a hull that is there.
void OperatorsView(benchmark::State& state, ViewSceneRig rig) {
  const VisualHull hull = SceneOf(rig).Hull();
  const auto limit = Limit(state);
  HullView view;
  for (auto _ : state) {
    view = ViewHull(hull, SceneOf(rig).view, {.surfaces = false});
    benchmark::DoNotOptimize(view);
  }
}

void HullOfMasks(benchmark::State& state, ViewSceneRig rig) {
  const MaskScene& scene = SceneOf(rig);
  const auto limit = Limit(state);
  for (auto _ : state) benchmark::DoNotOptimize(scene.Hull().IsEmpty());
}

// The hull is made anew each time, as for a frame: what it builds when first asked belongs to the cost.
void MeshAt2Mm(benchmark::State& state, ViewSceneRig rig) {
  const MaskScene& scene = SceneOf(rig);
  const auto limit = Limit(state);
  HullMesh last;
  for (auto _ : state) last = MeshHull(scene.Hull(), 2.0);
  state.counters["triangles"] = static_cast<double>(last.mesh.triangles.size());
  state.counters["cells"] = static_cast<double>(last.cells);
  state.counters["queries"] = static_cast<double>(last.queries);
  state.counters["skipped_cells"] = static_cast<double>(last.skipped_cells);
}

#define ON_EVERY_RIG(what)                                                                                   \
  BENCHMARK_CAPTURE(what, three_cameras, ViewSceneRig::kThree)                                               \
      ->Arg(1)                                                                                               \
      ->Arg(2)                                                                                               \
      ->Unit(benchmark::kMillisecond);                                                                       \
  BENCHMARK_CAPTURE(what, four_cameras, ViewSceneRig::kFour)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond); \
  BENCHMARK_CAPTURE(what, paper, ViewSceneRig::kPaper)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond);       \
  BENCHMARK_CAPTURE(what, eight_cameras, ViewSceneRig::kEight)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)
ON_EVERY_RIG(ExactView);
ON_EVERY_RIG(OperatorsView);
ON_EVERY_RIG(HullOfMasks);
ON_EVERY_RIG(MeshAt2Mm);
#undef ON_EVERY_RIG

}  // namespace
}  // namespace elbowroom::recon
