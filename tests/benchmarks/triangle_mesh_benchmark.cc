// What is asked once of every part that is loaded.
#include <benchmark/benchmark.h>

#include <cmath>
#include <numbers>

#include "core/triangle_mesh.h"

namespace elbowroom::core {
namespace {

// A torus of 2 * rings * sides triangles: closed, without special vertices.
TriangleMesh MakeTorus(int rings, int sides) {
  constexpr double kRadiusMm = 100.0, kTubeMm = 30.0;
  TriangleMesh mesh;
  for (int i = 0; i < rings; ++i) {
    const double u = 2.0 * std::numbers::pi * i / rings;
    for (int j = 0; j < sides; ++j) {
      const double v = 2.0 * std::numbers::pi * j / sides, r = kRadiusMm + kTubeMm * std::cos(v);
      mesh.vertices_mm.emplace_back(r * std::cos(u), r * std::sin(u), kTubeMm * std::sin(v));
      const int i1 = (i + 1) % rings, j1 = (j + 1) % sides;
      const int a = i * sides + j, b = i1 * sides + j, c = i1 * sides + j1, d = i * sides + j1;
      mesh.triangles.push_back({a, b, c});
      mesh.triangles.push_back({a, c, d});
    }
  }
  return mesh;
}

const TriangleMesh& Torus() {
  static const TriangleMesh mesh = MakeTorus(200, 125);
  return mesh;
}

void Watertight(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(IsWatertight(Torus()));
}
BENCHMARK(Watertight)->Unit(benchmark::kMillisecond);

void Hash(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(ContentHash(Torus()));
}
BENCHMARK(Hash)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace elbowroom::core
