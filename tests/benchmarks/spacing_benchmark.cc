// What a spacing study costs for parts of several shapes, beside asking every frame at every step.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <vector>

#include "core/bvh.h"
#include "core/layout.h"
#include "recon/hull/visual_hull.h"
#include "review/clearance.h"
#include "review/contacts.h"
#include "review/spacing_study.h"
#include "tests/core/solids.h"
#include "tests/review/sweeping_hand.h"
#include "tests/support/hard_parts.h"
#include "tests/support/panel_mesh.h"

namespace elbowroom::review {
namespace {

using core::TriangleMesh;
using Eigen::Vector3d;

constexpr int kFrames = 30;
constexpr double kRequiredMm = 15.0;

// A base under the table, and the part above it. The hand reaches from 40 to 280 mm above the table.
core::Layout LayoutOf(TriangleMesh mesh) {
  core::Part base, part;
  base.name = "base", part.name = "part";
  base.mesh = std::make_shared<const TriangleMesh>(core::testing::Box({10.0, 10.0, 10.0}));
  base.world_from_part.translation_mm = {0.0, 0.0, -50.0};
  part.mesh = std::make_shared<const TriangleMesh>(std::move(mesh));
  core::Layout layout;
  layout.parts = {base, part};
  layout.spacings = {{"gap", "part", "base", core::Axis::kZ, 0.0, 600.0, 100.0}};
  return layout;
}

struct Agreement {
  double worst_depth_mm = 0.0;   // between largest depths
  double worst_bounds_mm = 0.0;  // how far the bounds of least distances miss each other
  double queries = 0.0;
};

// Every frame at every step, each on its own.
Agreement AskAll(const core::Layout& layout, const std::vector<StudyFrame>& frames,
                 const SpacingStudy& study) {
  const core::TriangleTree tree(layout.parts[1].mesh);
  Agreement agreement;
  for (const StudyStep& step : study.curves[0].steps) {
    double deepest_mm = 0.0, lower_mm = 1e9, upper_mm = 1e9;
    const core::RigidTransform pose = core::PosesAt(layout, std::vector{step.spacing_mm})[1];
    for (const StudyFrame& frame : frames) {
      const core::PartContact contact = FindContacts(*frame.hull, tree, pose, 1);
      agreement.queries += static_cast<double>(contact.count.queries);
      if (contact.verdict == core::Verdict::kContact) {
        deepest_mm = std::max(deepest_mm, contact.deepest ? contact.deepest->depth_mm : 0.0);
        lower_mm = upper_mm = 0.0;
        continue;
      }
      const Clearance clearance = FindClearance(*frame.hull, tree, pose);
      agreement.queries += static_cast<double>(clearance.queries);
      lower_mm = std::min(lower_mm, clearance.interval.lower_mm);
      upper_mm = std::min(upper_mm, clearance.interval.upper_mm);
    }
    const PartAtSpacing& part = step.parts[1];
    agreement.worst_depth_mm = std::max(agreement.worst_depth_mm, std::abs(part.deepest_mm - deepest_mm));
    agreement.worst_bounds_mm =
        std::max({agreement.worst_bounds_mm, part.lower_mm - upper_mm, lower_mm - part.upper_mm});
  }
  return agreement;
}

void StudyOf(benchmark::State& state, const std::function<TriangleMesh()>& make_part) {
  const core::Layout layout = LayoutOf(make_part());
  std::vector<StudyFrame> frames;
  for (const auto& hull : PokingHand(kFrames))
    frames.push_back({static_cast<core::FrameIndex>(frames.size()), hull, {100.0}});
  SpacingStudyOptions options;
  options.from_mm = 50.0, options.to_mm = 450.0, options.step_mm = 10.0;
  options.review.required_clearance_mm = kRequiredMm;
  const StudyFrames source{frames.size(), [&](std::size_t i) { return frames[i]; }};
  SpacingStudy study = StudySpacing(layout, source, options);
  const Agreement all = AskAll(layout, frames, study);
  for (auto _ : state) benchmark::DoNotOptimize(study = StudySpacing(layout, source, options));
  std::int64_t in_contact = 0;
  for (const StudyStep& step : study.curves[0].steps) in_contact += step.parts[1].frames_in_contact;
  state.counters["steps"] = static_cast<double>(study.curves[0].steps.size());
  state.counters["frames"] = kFrames;
  state.counters["in_contact"] = static_cast<double>(in_contact);
  state.counters["queries"] = static_cast<double>(study.count.queries);
  state.counters["queries_of_all"] = all.queries;
  state.counters["worst_depth_mm"] = all.worst_depth_mm;
  state.counters["worst_bounds_mm"] = all.worst_bounds_mm;
}

TriangleMesh Box() {
  return core::Transformed(core::testing::Box({300.0, 200.0, 60.0}),
                           {Eigen::Matrix3d::Identity(), {-150.0, -100.0, -30.0}});
}
TriangleMesh Panel() {
  return test_support::PanelMesh(20, 18, {-200.0, -180.0, 0.0}, {400.0, 0.0, 0.0}, {0.0, 360.0, 0.0});
}

BENCHMARK_CAPTURE(StudyOf, SpacingStudy_box, Box)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(StudyOf, SpacingStudy_panel, Panel)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(StudyOf, SpacingStudy_bore, [] {
  return test_support::BoreMesh(90.0, 300.0, 28'000);
})->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(StudyOf, SpacingStudy_needles, [] {
  return test_support::NeedleForestMesh(200.0, 60.0, 28'000);
})->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace elbowroom::review
