// What sections and measurements cost: the figures of docs/view_tools.md.
#include <memory>
#include <string>
#include <vector>

#include "app/control/demo_parts.h"
#include "app/control/measuring/measurement.h"
#include "app/control/scene_composer.h"
#include "app/control/section/mesh_cut.h"
#include "recon/exact_view/hull_view.h"
#include "recon/hull/visual_hull.h"
#include "tests/app/demo_frame.h"
#include "tests/app/overlay/overlay_samples.h"
#include "tests/support/processor_time.h"

int main() {
  using namespace elbowroom::control;
  using Eigen::Vector3d;
  using elbowroom::test_support::PrintCost;
  const SectionCut cut{{{-Vector3d::UnitY(), -5.0}}};
  const Vector3d oblique = Vector3d(0.2, -1.0, 0.3).normalized();
  const SectionCut cut_obliquely{{{oblique, -5.0}}};
  for (const elbowroom::core::Part& part : DemoLayout().parts)
    PrintCost("cut " + part.name + ", " + std::to_string(part.mesh->triangles.size()) + " triangles",
              [&] { (void)CutOpen(*part.mesh, part.world_from_part, cut); });
  const elbowroom::core::TriangleMesh ball = BallMesh(90.0, 480);
  PrintCost("cut a ball, " + std::to_string(ball.triangles.size()) + " triangles",
            [&] { (void)CutOpen(ball, {}, cut); });
  PrintCost("cut it at an angle", [&] { (void)CutOpen(ball, {}, cut_obliquely); });
  const SharedFrameResult frame = DemoFrame();
  SceneLook look;
  PrintCost("compose 800 x 600, whole", [&] { (void)SceneComposer().Compose(*frame, DemoView(), look); });
  // The same cut of the hull by a face of a smaller workspace, and by a half-space.
  const elbowroom::recon::ViewRays rays(CameraOf(DemoView()));
  PrintCost("the hull's view, in a smaller workspace", [&] {
    auto rig = std::make_shared<elbowroom::core::Rig>(frame->hull->rig());
    rig->workspace_mm.min().y() = 5.0;
    const auto silhouettes = frame->hull->silhouettes();
    const elbowroom::recon::VisualHull smaller(std::move(rig), {silhouettes.begin(), silhouettes.end()});
    (void)elbowroom::recon::ViewHull(smaller, rays);
  });
  PrintCost("the hull's view, within a half-space",
            [&] { (void)elbowroom::recon::ViewHull(*frame->hull, rays.Within(cut.kept)); });
  for (const bool is_oblique : {false, true}) {
    look.cut = is_oblique ? cut_obliquely : cut;
    const std::string how = is_oblique ? "cut at an angle" : "cut";
    PrintCost("compose 800 x 600, " + how + " anew",
              [&] { (void)SceneComposer().Compose(*frame, DemoView(), look); });
    SceneComposer kept;
    PrintCost("compose 800 x 600, " + how + ", kept", [&] { (void)kept.Compose(*frame, DemoView(), look); });
  }
  PrintCost("a place to the hull", [&] {
    (void)MeasureToHull({0, {100.0, 50.0, 120.0}, {0, 0, 1}}, *frame);
  });
}
