// What the 3-D view's layers cost, and how far the hull's are from their definitions: docs/view_tools.md.
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "app/control/demo_trial.h"
#include "app/control/layers/heat_layer.h"
#include "app/control/layers/hull_colors.h"
#include "app/control/scene_composer.h"
#include "core/surface_patches.h"
#include "recon/hull/visual_hull.h"
#include "tests/app/demo_frame.h"
#include "tests/app/overlay/overlay_samples.h"
#include "tests/recon/surface_quality/quality_scenes.h"
#include "tests/support/processor_time.h"

namespace elbowroom::control {
namespace {

using recon::HullAppearance;
using test_support::PrintCost;

core::HeatMap MapOf(const core::SharedMesh& mesh, double share) {
  const core::SurfacePatches patches(mesh, core::kHeatPatchMm);
  core::HeatMap map;
  map.dwell_s.assign(patches.size(), 0.0F);
  const auto touched = static_cast<std::size_t>(share * static_cast<double>(patches.size()));
  for (std::size_t i = 0; i < touched; ++i)
    map.dwell_s[i] = static_cast<float>(i + 1) / static_cast<float>(touched);
  return map;
}

void MeasureHeat(const std::string& what, const core::SharedMesh& mesh) {
  const core::HeatMap map = MapOf(mesh, 0.1), more = MapOf(mesh, 0.101);
  HeatLayerMaker maker({mesh});
  const std::string patches = std::to_string(map.dwell_s.size());
  bool is_more = false;
  PrintCost("heat of " + what + ", " + patches + " patches, a tenth touched: anew", [&] {
    is_more = !is_more;
    maker.Take(is_more ? more : map);
    (void)maker.Make();
  });
  PrintCost("  the same again", [&] {
    maker.Take(map);
    (void)maker.Make();
  });
}

void MeasureComposing(const FrameResult& frame, const FrameResult& next, const SharedRigKnowledge& knowledge,
                      const SharedHeatLayer& heat) {
  const auto measure = [&](const std::string& what, const SceneLook& look) {
    SceneComposer composer;
    bool is_next = false;
    PrintCost("compose 800 x 600, another hull each time: " + what, [&] {
      is_next = !is_next;
      (void)composer.Compose(is_next ? next : frame, DemoView(), look);
    });
  };
  SceneLook look;
  look.knowledge = knowledge;
  measure("shaded", look);
  look.heat = heat;
  measure("shaded, with heat", look);
  look.heat = nullptr;
  look.hull = HullAppearance::kRigCameras;
  measure("camera colours", look);
  look.hull = HullAppearance::kCoverage;
  measure("coverage", look);
  look.hull = HullAppearance::kUncertainty;
  measure("uncertainty", look);
}

// The definition, pixel by pixel.
void MeasureExact(const recon::QualityScene& scene) {
  recon::Random random(2520);
  const recon::SurfaceUncertainty fast(*scene.rig, {recon::DrawCovariance(*scene.rig, &random), 0.2});
  const recon::ViewRays rays = recon::ViewsOf(scene)[0];
  const recon::HullView picture = recon::ViewHull(*scene.hull, rays);
  const std::string pixels = std::to_string(picture.hit_pixels) + " pixels";
  PrintCost(scene.name + ", uncertainty of " + pixels + ": by the table",
            [&] { (void)fast.Of(*scene.hull, picture, rays); });
  PrintCost("  as a verdict's budget, pixel by pixel", [&] {
    for (std::size_t at = 0; at < picture.depth_mm.size(); ++at) {
      if (!picture.surface[at].camera()) continue;
      const auto width = static_cast<std::size_t>(picture.width_px);
      const Eigen::Vector3d x =
          rays.view_from_world().Inverse() * recon::PlaceInView(rays, static_cast<int>(at % width),
                                                                static_cast<int>(at / width),
                                                                static_cast<double>(picture.depth_mm[at]));
      (void)fast.errors().At(*scene.hull, x, x + picture.normal_in_world[at].cast<double>());
    }
  });
  recon::SurfaceCoverage coverage(*scene.rig);
  PrintCost("  the cameras' looks at the hull", [&] { coverage.LookAt(*scene.hull); });
  PrintCost("  coverage of as many pixels", [&] { (void)coverage.Of(*scene.hull, picture, rays); });
  PrintCost("  the uncertainty's table, once a rig",
            [&] { recon::SurfaceUncertainty(*scene.rig, fast.errors().errors()); });
}

}  // namespace
}  // namespace elbowroom::control

int main() {
  using namespace elbowroom;
  using namespace elbowroom::control;
  TrialSetup setup = MakeDemoTrial(DemoPlay::kOnce);
  std::vector<core::SharedMesh> meshes;
  for (const core::Part& part : setup.layout.parts) meshes.push_back(part.mesh);
  MeasureHeat(setup.layout.parts[0].name, meshes[0]);
  MeasureHeat("a ball", std::make_shared<const core::TriangleMesh>(BallMesh(90.0, 480)));
  HeatLayerMaker maker(meshes);
  maker.Take(MapOf(meshes[0], 0.1));
  const SharedFrameResult frame = DemoFrame(), next = DemoFrame(kFrameAtPayload + 1);
  MeasureComposing(*frame, *next, KnowledgeOf(setup.source->rig(), {}), maker.Make());
  for (int rig = 0; rig < recon::kQualityRigs; ++rig) MeasureExact(recon::MakeQualityScene(rig, 0));
}
