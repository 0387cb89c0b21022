#include <benchmark/benchmark.h>

#include <vector>

#include "recon/consistency/tangencies.h"
#include "recon/contours/contour.h"
#include "tests/recon/consistency/hand_stage.h"
#include "tests/recon/consistency/moving_hands.h"

namespace elbowroom::recon::testing {
namespace {

// A frame of four 640 x 480 cameras that see two hands.
struct TangencyFrame {
  HandStage stage{HandRig(4)};
  std::vector<core::SoftMask> masks =
      stage.MasksOf(HandsAt({.shape = MovingShape::kTwoHands}, 1.0), {.noise_px = 0.18, .seed = 1});
};

// The whole of it, the tracing of the contours included.
void Tangencies(benchmark::State& state) {
  const TangencyFrame frame;
  for (auto _ : state) benchmark::DoNotOptimize(FindTangencies(frame.stage.pairs, frame.masks));
}
BENCHMARK(Tangencies)->Unit(benchmark::kMicrosecond);

// With contours that the hull has traced already.
void TangenciesOfContours(benchmark::State& state) {
  const TangencyFrame frame;
  std::vector<Contour> contours;
  for (core::CameraIndex i = 0; i < 4; ++i)
    contours.push_back(TraceContour(frame.masks[i], false, *frame.stage.planes[i]));
  for (auto _ : state) {
    std::vector<CameraTangents> tangents;
    for (core::CameraIndex i = 0; i < 4; ++i)
      tangents.push_back(FindTangents(frame.stage.pairs, i, frame.masks[i], contours[i]));
    benchmark::DoNotOptimize(CompareTangents(frame.stage.pairs, tangents, frame.masks));
  }
}
BENCHMARK(TangenciesOfContours)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace elbowroom::recon::testing
