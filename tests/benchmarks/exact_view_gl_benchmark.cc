// Exact views of the demo's hand by the graphics card, beside the processor's: from masks in memory to a
// 640 x 480 depth picture.
#include <benchmark/benchmark.h>
#include <tbb/global_control.h>

#include <memory>

#include "recon/contours/undistorted_plane.h"
#include "recon/exact_view/view_comparison.h"
#include "recon/gl/exact_view/exact_view_gl.h"
#include "recon/hull/visual_hull.h"
#include "recon/synthetic/view_scene.h"

namespace elbowroom::recon {
namespace {

// What is new in each picture; a benchmark's name says which.
enum class Fresh { kNothing, kView, kMasks };

void ExactViewGl(benchmark::State& state, ViewSceneRig of_rig, Fresh fresh) {
  const ViewScene scene = MakeViewScene(of_rig);
  const auto rig = std::make_shared<const core::Rig>(scene.rig);
  const tbb::global_control threads(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(state.range(0)));
  const UndistortedPlanes planes = MakeUndistortedPlanes(*rig);
  const std::vector<core::SoftMask> masks = TrueMasks(*rig, scene.objects);
  const ViewRays rays(scene.view);
  core::RigidTransform moved = scene.view.cam_from_world();
  moved.translation_mm.x() += 1e-3;
  const ViewRays views[2] = {rays, rays.From(moved)};
  HullViewOptions options;
  options.surfaces = options.normals = false;
  gl::ExactViewGl card;
  VisualHull hull = MakeVisualHull(rig, planes, masks);
  HullView view = card.ViewHull(hull, rays, options);
  const ViewComparison comparison = CompareViews(hull, rays, recon::ViewHull(hull, rays, options), view);
  std::size_t number = 0;
  for (auto _ : state) {
    if (fresh == Fresh::kMasks) hull = MakeVisualHull(rig, planes, masks);
    if (fresh == Fresh::kView) ++number;
    view = card.ViewHull(hull, views[number % 2], options);
    benchmark::DoNotOptimize(view.depth_mm.data());
  }
  state.SetLabel(card.driver());
  state.counters["hit_pixels"] = static_cast<double>(view.hit_pixels);
  state.counters["cast_pixels"] = static_cast<double>(view.cast_pixels);
  state.counters["band_pixels"] = static_cast<double>(comparison.band_pixels);
  state.counters["differing_in_band"] = static_cast<double>(comparison.differing_in_band);
  state.counters["differing"] = static_cast<double>(comparison.differing_pixels);
  state.counters["max_mm"] = comparison.largest_difference_mm;
}
#define ON(name, of_rig, fresh)                       \
  BENCHMARK_CAPTURE(ExactViewGl, name, of_rig, fresh) \
      ->ArgName("threads")                            \
      ->Arg(1)                                        \
      ->Arg(2)                                        \
      ->Unit(benchmark::kMillisecond)                 \
      ->UseRealTime()
ON(three_cameras_nothing_new, ViewSceneRig::kThree, Fresh::kNothing);
ON(three_cameras_new_view, ViewSceneRig::kThree, Fresh::kView);
ON(three_cameras_new_masks, ViewSceneRig::kThree, Fresh::kMasks);
ON(eight_cameras_nothing_new, ViewSceneRig::kEight, Fresh::kNothing);
ON(eight_cameras_new_view, ViewSceneRig::kEight, Fresh::kView);
ON(eight_cameras_new_masks, ViewSceneRig::kEight, Fresh::kMasks);
#undef ON

}  // namespace
}  // namespace elbowroom::recon
