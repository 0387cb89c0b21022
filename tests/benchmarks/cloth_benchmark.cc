// What a frame of the paper's curtain, 720 triangles, costs: nobody near, a hand that rests on it, the demo's
// hand that moves through it. Beside the time: what the springs have left over.
#include <benchmark/benchmark.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include "recon/synthetic/demo_motion.h"
#include "recon/synthetic/rig_presets.h"
#include "recon/synthetic/view_scene.h"
#include "review/cloth.h"

namespace elbowroom::review {
namespace {

using Eigen::Vector3d;
using SharedHull = std::shared_ptr<const recon::VisualHull>;

constexpr double kFrameS = 1.0 / 30.0;
constexpr double kHandIsInS = 5.0;  // of the demo's task

core::Part Curtain() {
  constexpr int kAcross = 20, kDown = 18;
  constexpr double kCellMm = 20.0;
  auto mesh = std::make_shared<core::TriangleMesh>();
  for (int z = 0; z <= kDown; ++z)
    for (int x = 0; x <= kAcross; ++x) mesh->vertices_mm.emplace_back(kCellMm * (x - 10), 0.0, -kCellMm * z);
  const auto at = [&](int x, int z) { return z * (kAcross + 1) + x; };
  for (int z = 0; z < kDown; ++z) {
    for (int x = 0; x < kAcross; ++x) {
      mesh->triangles.push_back({at(x, z), at(x, z + 1), at(x + 1, z)});
      mesh->triangles.push_back({at(x + 1, z), at(x, z + 1), at(x + 1, z + 1)});
    }
  }
  core::ClothRule rule;
  rule.pins = {core::BoundsSide::kZMax};
  core::Part part;
  part.name = "curtain";
  part.mesh = std::move(mesh);
  part.gives_way = rule;
  return part;
}

// The demo's hand from `from_mm` along y, there and back, a hull a frame.
std::vector<SharedHull> Hulls(double reach_mm, double speed_mm_per_s) {
  const auto rig = std::make_shared<const core::Rig>(recon::FourCameraRig());
  const int frames = std::max(1, static_cast<int>(std::lround(2.0 * reach_mm / (speed_mm_per_s * kFrameS))));
  std::vector<SharedHull> hulls;
  for (int i = 0; i < frames; ++i) {
    std::vector<recon::SyntheticObject> objects = recon::DemoSceneAt(kHandIsInS).objects;
    const double along_mm = 0.5 * reach_mm * (1.0 - std::cos(2.0 * std::numbers::pi * i / frames));
    for (recon::SyntheticObject& object : objects)
      for (recon::Solid& solid : object.solids) solid.world_from_solid.translation_mm.y() += along_mm;
    hulls.push_back(std::make_shared<const recon::VisualHull>(
        recon::MakeVisualHull(rig, recon::TrueMasks(*rig, objects))));
  }
  return hulls;
}

void CurtainFrame(benchmark::State& bench, double curtain_y_mm, double reach_mm) {
  const ClothPanel panel(Curtain());
  core::RigidTransform pose;
  pose.translation_mm = Vector3d(80.0, curtain_y_mm, 420.0);
  const std::vector<SharedHull> hulls = Hulls(reach_mm, 500.0);
  ClothState state = ClothAtRest(panel, pose);
  std::size_t frame = 0;
  for (; frame < 3 * hulls.size() + 30; ++frame)
    state = StepCloth(panel, std::move(state), pose, hulls[frame % hulls.size()], kFrameS);
  double worst = 0.0, mean = 0.0, queries = 0.0, contacts = 0.0;
  for (auto _ : bench) {
    state = StepCloth(panel, std::move(state), pose, hulls[frame++ % hulls.size()], kFrameS);
    worst = std::max(worst, state.count.worst_stretch);
    mean += state.count.mean_stretch;
    queries += static_cast<double>(state.count.queries);
    contacts += static_cast<double>(state.count.contacts);
  }
  bench.counters["worst_stretch"] = worst;
  bench.counters["mean_stretch"] = benchmark::Counter(mean, benchmark::Counter::kAvgIterations);
  bench.counters["queries"] = benchmark::Counter(queries, benchmark::Counter::kAvgIterations);
  bench.counters["contacts"] = benchmark::Counter(contacts, benchmark::Counter::kAvgIterations);
}

BENCHMARK_CAPTURE(CurtainFrame, nobody_near, -380.0, 0.0)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(CurtainFrame, hand_rests_in_it, 20.0, 0.0)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(CurtainFrame, hand_moves_through_it, 60.0, 120.0)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace elbowroom::review
