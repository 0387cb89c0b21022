// Frames in memory to masks.
#include <benchmark/benchmark.h>
#include <tbb/global_control.h>

#include "recon/frame_segmenter.h"
#include "recon/synthetic/synthetic_rig.h"
#include "recon/synthetic/view_scene.h"

namespace elbowroom::recon {
namespace {

struct FrameScene {
  FrameSegmenter segmenter;
  FrameSet frames;
};

const FrameScene& FourCameras() {
  static const FrameScene scene = [] {
    const ViewScene view = MakeViewScene(ViewSceneRig::kFour);
    SyntheticRig rig(view.rig, [objects = view.objects](double) { return objects; });
    return FrameScene{FrameSegmenter(rig.ReadBackgrounds({}, {}), {}), rig.Read(0)};
  }();
  return scene;
}

// 4 x 640 x 480 BGR; the argument is the number of threads.
void Segment(benchmark::State& state) {
  const FrameScene& scene = FourCameras();
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                  static_cast<std::size_t>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(scene.segmenter.Segment(scene.frames));
}
BENCHMARK(Segment)->Name("Segment/4x640x480")->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace elbowroom::recon
