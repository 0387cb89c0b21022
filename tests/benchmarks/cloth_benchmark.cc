// What a frame of a curtain of 720 triangles costs: nobody near, a hand that rests on it, the demo's
// hand that moves through it. Beside the time: what the springs have left over.
#include <benchmark/benchmark.h>

#include <memory>
#include <utility>
#include <vector>

#include "recon/hull/visual_hull.h"
#include "recon/hull_mesh/hull_mesh.h"
#include "review/cloth.h"
#include "tests/review/curtain.h"
#include "tests/review/sweeping_hand.h"

namespace elbowroom::review {
namespace {

using SharedHull = std::shared_ptr<const recon::VisualHull>;

constexpr double kFrameS = 1.0 / 30.0;

constexpr int kFramesOfPush = 12;  // 700 mm/s at most

enum class Hand { kFar, kStops, kMoves };

// The curtain hangs across x before the fingers, or far behind the table.
void CurtainFrame(benchmark::State& bench, Hand hand) {
  const ClothPanel panel(Curtain());
  const std::vector<SharedHull> hulls = PokingHand(kFramesOfPush);
  constexpr double kGapMm = 15.0;
  const double before_hand_mm = core::BoundsOf(recon::MeshHull(*hulls[0], 5.0).mesh).min().x() - kGapMm;
  const core::RigidTransform pose = core::FromPositionAndRollPitchYaw(
      {hand == Hand::kFar ? -380.0 : before_hand_mm, 0.0, 420.0}, {0.0, 0.0, 90.0});
  ClothState state = ClothAtRest(panel, pose);
  // Hangs itself out, is pushed once; the hand that stops does so where it reaches farthest.
  for (int i = 0; i < 60; ++i) state = StepCloth(panel, std::move(state), pose, hulls[0], kFrameS);
  std::size_t frame = 0;
  for (; frame < kFramesOfPush / 2; ++frame)
    state = StepCloth(panel, std::move(state), pose, hulls[frame], kFrameS);
  // Equal hulls, but another snapshot every frame, as a camera's noise makes them.
  const SharedHull stopped[] = {hulls[kFramesOfPush / 2],
                                std::make_shared<const recon::VisualHull>(*hulls[kFramesOfPush / 2])};
  const auto next = [&]() -> const SharedHull& {
    ++frame;
    return hand == Hand::kStops ? stopped[frame % 2] : hulls[frame % hulls.size()];
  };
  for (int i = 0; i < 3 * kFramesOfPush; ++i)
    state = StepCloth(panel, std::move(state), pose, next(), kFrameS);
  double worst = 0.0, mean = 0.0, queries = 0.0, contacts = 0.0;
  for (auto _ : bench) {
    state = StepCloth(panel, std::move(state), pose, next(), kFrameS);
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

BENCHMARK_CAPTURE(CurtainFrame, hand_far, Hand::kFar)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(CurtainFrame, hand_stops_in_it, Hand::kStops)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(CurtainFrame, hand_pushes_it, Hand::kMoves)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace elbowroom::review
