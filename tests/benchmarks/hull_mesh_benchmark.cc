// The demo's hand as a closed mesh of 2 mm edges.
#include <benchmark/benchmark.h>
#include <tbb/global_control.h>

#include <memory>
#include <vector>

#include "recon/hull_mesh.h"
#include "recon/synthetic/demo_motion.h"
#include "recon/synthetic/rig_presets.h"
#include "recon/synthetic/synthetic_rig.h"

namespace elbowroom::recon {
namespace {

constexpr double kTimeS = 4.0;

void Mesh(benchmark::State& state) {
  const auto rig =
      std::make_shared<const core::Rig>(state.range(0) == 8 ? EightCameraRig() : FourCameraRig());
  const tbb::global_control threads(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(state.range(1)));
  SyntheticRig synthetic(*rig, [](double time_s) { return DemoSceneAt(time_s).objects; });
  std::vector<core::SoftMask> masks;
  std::vector<SyntheticObject> hand;
  for (SyntheticObject& object : DemoSceneAt(kTimeS).objects)
    if (object.name == "hand") hand.push_back(object);
  for (core::BitMask& mask : synthetic.TrueMasks(hand.empty() ? DemoSceneAt(kTimeS).objects : hand))
    masks.push_back({std::move(mask), {}});
  const PicturePlanes planes = MakePicturePlanes(*rig);
  HullMesh mesh;
  for (auto _ : state) {
    mesh = MeshHull(MakeVisualHull(rig, planes, masks), 2.0);
    benchmark::DoNotOptimize(mesh.mesh.triangles.data());
  }
  state.counters["triangles"] = static_cast<double>(mesh.mesh.triangles.size());
  state.counters["cells"] = static_cast<double>(mesh.cells);
  state.counters["queries"] = static_cast<double>(mesh.queries);
  state.counters["watertight"] = core::IsWatertight(mesh.mesh) ? 1.0 : 0.0;
  state.counters["litres"] = core::VolumeMm3(mesh.mesh) * 1e-6;
}
BENCHMARK(Mesh)
    ->ArgNames({"cameras", "threads"})
    ->ArgsProduct({{4, 8}, {1, 2}})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

}  // namespace
}  // namespace elbowroom::recon
