// What it costs to judge pair rules after a gap was changed: `pair_cost`, of built-in layouts, or of a
// LAYOUT.toml. Median and longest of the steps, with what is skipped and without.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "app/control/demo_parts.h"
#include "app/control/pairs/pair_judge.h"
#include "app/control/pairs/ruled_pairs.h"
#include "cad_import/import_worker.h"
#include "cad_import/layout/layout_file.h"
#include "review/clash.h"
#include "tests/app/pairs/ruled_layouts.h"

namespace elbowroom::control {
namespace {

constexpr int kSteps = 30;
constexpr double kRequiredMm = 20.0;

double Milliseconds(const auto& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
}

// Two balls with bumps, one above the other.
core::Layout Balls(int rings) {
  core::TriangleMesh mesh;
  for (int i = 0; i <= rings; ++i) {
    for (int j = 0; j < 2 * rings; ++j) {
      const double polar = std::numbers::pi * i / rings, azimuth = std::numbers::pi * j / rings;
      const double radius_mm = 150.0 + std::sin(20.0 * polar) * std::sin(20.0 * azimuth);
      mesh.vertices_mm.emplace_back(radius_mm * std::sin(polar) * std::cos(azimuth),
                                    radius_mm * std::sin(polar) * std::sin(azimuth),
                                    radius_mm * std::cos(polar));
    }
  }
  for (int i = 0; i < rings; ++i) {
    for (int j = 0; j < 2 * rings; ++j) {
      const int a = i * 2 * rings + j, b = i * 2 * rings + (j + 1) % (2 * rings);
      mesh.triangles.push_back({a, a + 2 * rings, b});
      mesh.triangles.push_back({b, a + 2 * rings, b + 2 * rings});
    }
  }
  core::Layout layout;
  layout.parts.resize(2);
  for (const char* name : {"lower", "upper"}) {
    core::Part& part = layout.parts[name[0] == 'u' ? 1 : 0];
    part.name = name;
    part.mesh = std::make_shared<const core::TriangleMesh>(mesh);
  }
  layout.spacings = {{"gap", "upper", "lower", core::Axis::kZ, 0.0, 100.0, 10.0}};
  layout.pair_rules = {{"lower", "upper", kRequiredMm, false}};
  return layout;
}

std::int64_t TrianglesOf(const core::Layout& layout) {
  std::int64_t triangles = 0;
  for (const core::Part& part : layout.parts)
    triangles += static_cast<std::int64_t>(part.mesh->triangles.size());
  return triangles;
}

std::string Text(std::vector<double> times_ms) {
  std::ranges::sort(times_ms);
  return fmt::format("{:9.3f} {:9.3f}", times_ms[times_ms.size() / 2], times_ms.back());
}

// The first spacing goes up and down in steps of a millimetre.
void Measure(const std::string& name, const core::Layout& layout) {
  const std::vector<review::PairDemand> pairs = RuledPairsOf(layout);
  PairJudge judge(layout, pairs);
  std::vector<double> gaps_mm = layout.InitialSpacings();
  const double first_ms = Milliseconds([&] { (void)judge.Judge({0, 0.0, gaps_mm}); });
  std::vector<double> skipping_ms, anew_ms;
  review::ClashCount count;
  for (int step = 1; step <= kSteps; ++step) {
    gaps_mm[0] = layout.spacings[0].initial_mm + 5.0 * std::sin(0.3 * step);
    skipping_ms.push_back(Milliseconds([&] { count += judge.Judge({step, 0.0, gaps_mm})->count; }));
    if (step % 6 != 0) continue;
    review::ClashChecker checker(layout, pairs);
    anew_ms.push_back(Milliseconds([&] { (void)checker.Check(core::PosesAt(layout, gaps_mm)); }));
  }
  fmt::print("{:<28} {:>3} {:>8} {:>5} {:>9.1f} {} {}  {} {} {}\n", name, layout.parts.size(),
             TrianglesOf(layout), pairs.size(), first_ms, Text(skipping_ms), Text(anew_ms),
             count.unchanged / kSteps, count.moved_together / kSteps, count.settled_by_bounds / kSteps);
  std::fflush(stdout);
}

}  // namespace
}  // namespace elbowroom::control

int main(int argc, char** argv) {
  using namespace elbowroom;
  cad_import::ServeImport(argc, argv);  // returns unless this is a child that imports
  std::mt19937_64 random(1);
  fmt::print(
      "layout, parts, triangles, pairs; ms: first, a change (median, longest), judged anew (median, "
      "longest); pairs unchanged, moved together, settled by bounds\n");
  for (int i = 1; i < argc; ++i) control::Measure(argv[i], cad_import::ImportLayoutFile(argv[i]).layout);
  if (argc > 1) return 0;
  control::Measure("demo", control::DemoLayout());
  std::vector<review::testing::PartKind> kinds;
  for (int i = 0; i < 41; ++i)
    kinds.push_back(static_cast<review::testing::PartKind>(i % review::testing::kPartKinds));
  control::Measure("41 small parts, stacked", control::testing::StackOf(kinds, random));
  control::Measure("two balls", control::Balls(50));
  control::Measure("two balls, finer", control::Balls(400));
  return 0;
}
