// What contacts and clearance of a part cost: the demo's hand and a panel of triangles, hull in memory.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <memory>

#include "core/bvh.h"
#include "recon/hull/visual_hull.h"
#include "recon/hull_mesh/hull_mesh.h"
#include "recon/synthetic/view_scene.h"
#include "review/clearance.h"
#include "review/contacts.h"
#include "tests/support/panel_mesh.h"

namespace elbowroom::review {
namespace {

using recon::ViewSceneRig;

// A level panel of 2 * across * down triangles, its middle at the origin.
core::TriangleTree Panel(int across, int down) {
  return core::TriangleTree(std::make_shared<const core::TriangleMesh>(
      test_support::PanelMesh(across, down, {-200.0, -180.0, 0.0}, {400.0, 0.0, 0.0}, {0.0, 360.0, 0.0})));
}

struct PanelScene {
  recon::VisualHull hull;
  Eigen::Vector3d lowest_in_world;  // of the hull
};

PanelScene SceneOf(ViewSceneRig rig) {
  const recon::ViewScene scene = recon::MakeViewScene(rig);
  recon::VisualHull hull = recon::MakeVisualHull(std::make_shared<const core::Rig>(scene.rig),
                                                 recon::TrueMasks(scene.rig, scene.objects));
  const recon::HullMesh mesh = recon::MeshHull(hull, 2.0);
  const auto lowest =
      std::ranges::min_element(mesh.mesh.vertices_mm, {}, [](const auto& v) { return v.z(); });
  return {std::move(hull), *lowest};
}

core::RigidTransform PanelAt(const PanelScene& scene, double gap_mm) {
  core::RigidTransform world_from_part;
  world_from_part.translation_mm = scene.lowest_in_world - Eigen::Vector3d(0.0, 0.0, gap_mm);
  return world_from_part;
}

void ClearanceAt30Mm(benchmark::State& state, ViewSceneRig rig, bool is_warm, int across = 20,
                     int down = 18) {
  const PanelScene scene = SceneOf(rig);
  const core::TriangleTree part = Panel(across, down);
  const core::RigidTransform pose = PanelAt(scene, 30.0);
  Clearance last = FindClearance(scene.hull, part, pose);
  std::optional<ClearanceHint> hint;
  if (is_warm)
    hint = ClearanceHint{pose.Inverse() * last.interval.witness_part_in_world_mm,
                         last.interval.witness_hull_in_world_mm};
  for (auto _ : state) benchmark::DoNotOptimize(last = FindClearance(scene.hull, part, pose, {}, hint));
  state.counters["lower_mm"] = last.interval.lower_mm;
  state.counters["upper_mm"] = last.interval.upper_mm;
  state.counters["queries"] = static_cast<double>(last.queries);
  state.counters["distances"] = static_cast<double>(last.distances);
}

void ContactsOfPanel(benchmark::State& state, ViewSceneRig rig, int across, int down) {
  const PanelScene scene = SceneOf(rig);
  const core::TriangleTree part = Panel(across, down);
  const core::RigidTransform pose = PanelAt(scene, -10.0);
  core::PartContact contact;
  for (auto _ : state) benchmark::DoNotOptimize(contact = FindContacts(scene.hull, part, pose, 0));
  state.counters["area_mm2"] = contact.contact_area_mm2;
  state.counters["points"] = static_cast<double>(contact.contact_point_count);
  state.counters["queries"] = static_cast<double>(contact.count.queries);
}

BENCHMARK_CAPTURE(ClearanceAt30Mm, three_cameras_cold, ViewSceneRig::kThree, false)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(ClearanceAt30Mm, three_cameras_warm, ViewSceneRig::kThree, true)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(ClearanceAt30Mm, eight_cameras_cold, ViewSceneRig::kEight, false)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(ClearanceAt30Mm, eight_cameras_warm, ViewSceneRig::kEight, true)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(ClearanceAt30Mm, three_cameras_1M, ViewSceneRig::kThree, false, 800, 625)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(ContactsOfPanel, three_cameras_720, ViewSceneRig::kThree, 20, 18)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(ContactsOfPanel, three_cameras_1k, ViewSceneRig::kThree, 25, 20)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(ContactsOfPanel, three_cameras_1M, ViewSceneRig::kThree, 800, 625)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(ContactsOfPanel, eight_cameras_720, ViewSceneRig::kEight, 20, 18)
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace elbowroom::review
