// What sections and measurements cost: the figures of docs/view_tools.md.
#include <algorithm>
#include <cstdio>
#include <ctime>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "app/control/demo_trial.h"
#include "app/control/frame_pipeline.h"
#include "app/control/measuring/measurement.h"
#include "app/control/scene_composer.h"
#include "app/control/section/mesh_cut.h"
#include "recon/exact_view/hull_view.h"
#include "recon/hull/visual_hull.h"
#include "tests/app/overlay/overlay_samples.h"

namespace elbowroom::control {
namespace {

constexpr int kRuns = 15;

// Median of the processor time of all threads.
void Measure(const std::string& what, const std::function<void()>& work) {
  std::vector<double> times_ms;
  work();
  for (int i = 0; i < kRuns; ++i) {
    const std::clock_t begin = std::clock();
    work();
    times_ms.push_back(1000.0 * static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC);
  }
  std::ranges::sort(times_ms);
  std::printf("%-48s %8.2f ms\n", what.c_str(), times_ms[kRuns / 2]);
}

recon::SceneView View() {
  recon::OrbitCamera camera;
  camera.target_in_world = {50.0, 0.0, 210.0};
  camera.distance_mm = 1350.0;
  return recon::ViewFrom(camera, 800, 600);
}

}  // namespace
}  // namespace elbowroom::control

int main() {
  using namespace elbowroom::control;
  using Eigen::Vector3d;
  const SectionCut cut{{{-Vector3d::UnitY(), -5.0}}};
  const Vector3d oblique = Vector3d(0.2, -1.0, 0.3).normalized();
  const SectionCut cut_obliquely{{{oblique, -5.0}}};
  TrialSetup setup = MakeDemoTrial(DemoPlay::kOnce);
  for (const elbowroom::core::Part& part : setup.layout.parts)
    Measure("cut " + part.name + ", " + std::to_string(part.mesh->triangles.size()) + " triangles",
            [&] { (void)CutOpen(*part.mesh, part.world_from_part, cut); });
  const elbowroom::core::TriangleMesh ball = BallMesh(90.0, 480);
  Measure("cut a ball, " + std::to_string(ball.triangles.size()) + " triangles",
          [&] { (void)CutOpen(ball, {}, cut); });
  Measure("cut it at an angle", [&] { (void)CutOpen(ball, {}, cut_obliquely); });
  FramePipeline pipeline(setup.source->rig(), setup.layout, setup.source->ReadBackgrounds({}, {}),
                         setup.segmentation);
  const SharedFrameResult frame = pipeline.Process(setup.source->Read(66), std::vector<double>{240.0});
  SceneLook look;
  Measure("compose 800 x 600, whole", [&] { (void)SceneComposer().Compose(*frame, View(), look); });
  // The same cut of the hull by a face of a smaller workspace, and by a half-space.
  const elbowroom::recon::ViewRays rays(CameraOf(View()));
  Measure("the hull's view, in a smaller workspace", [&] {
    auto rig = std::make_shared<elbowroom::core::Rig>(frame->hull->rig());
    rig->workspace_mm.min().y() = 5.0;
    const auto silhouettes = frame->hull->silhouettes();
    const elbowroom::recon::VisualHull smaller(std::move(rig), {silhouettes.begin(), silhouettes.end()});
    (void)elbowroom::recon::ViewHull(smaller, rays);
  });
  Measure("the hull's view, within a half-space",
          [&] { (void)elbowroom::recon::ViewHull(*frame->hull, rays.Within(cut.kept)); });
  for (const bool is_oblique : {false, true}) {
    look.cut = is_oblique ? cut_obliquely : cut;
    const std::string how = is_oblique ? "cut at an angle" : "cut";
    Measure("compose 800 x 600, " + how + " anew",
            [&] { (void)SceneComposer().Compose(*frame, View(), look); });
    SceneComposer kept;
    Measure("compose 800 x 600, " + how + ", kept", [&] { (void)kept.Compose(*frame, View(), look); });
  }
  Measure("a place to the hull", [&] { (void)MeasureToHull({0, {100.0, 50.0, 120.0}, {0, 0, 1}}, *frame); });
}
