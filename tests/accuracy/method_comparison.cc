#include "tests/accuracy/method_comparison.h"

#include <functional>

#include "tests/oracles/analytic_hull.h"
#include "tests/oracles/mask_hull_oracle.h"

namespace elbowroom::accuracy {
namespace {

// What the methods take a mask for: docs/accuracy.md, "Conventions".
constexpr auto kConvention = oracles::BoundaryConvention::kMarchingSquares;

}  // namespace

ComparedScene MakeComparedScene(const std::string& name, recon::ViewSceneRig rig, int view_width_px,
                                int view_height_px) {
  recon::ViewScene scene = recon::MakeViewScene(rig, view_width_px, view_height_px);
  std::vector<core::SoftMask> masks = recon::TrueMasks(scene.rig, scene.objects);
  const oracles::MaskHullOracle oracle(scene.rig, masks, kConvention);
  const oracles::AnalyticHull analytic(scene.rig, recon::AllSolids(scene.objects));
  SurfacePicture mask_hull(
      scene.view, PictureOf(scene.view, [&](const recon::Ray& ray) { return oracle.FirstSurface(ray); }));
  SurfacePicture analytic_hull(
      scene.view, PictureOf(scene.view, [&](const recon::Ray& ray) { return analytic.FirstSurface(ray); }));
  ViewTask task(std::make_shared<const core::Rig>(std::move(scene.rig)), std::move(masks), scene.view);
  return {name, std::move(task), std::move(mask_hull), std::move(analytic_hull)};
}

std::vector<MethodResult> CompareMethods(const ComparedScene& scene, const TimingEffort& effort) {
  std::vector<MethodResult> results;
  std::vector<std::function<void()>> jobs;
  for (const ViewMethod& method : ViewMethods()) {
    const recon::DepthMap found = method.view(scene.task);
    results.push_back(
        {method, ErrorAgainst(scene.mask_hull, found), ErrorAgainst(scene.analytic_hull, found), {}, {}});
    jobs.emplace_back([&task = scene.task, view = method.view] { (void)view(task); });
  }
  const std::vector<Timing> one = TimeInTurns(jobs, 1, effort), two = TimeInTurns(jobs, 2, effort);
  for (std::size_t i = 0; i < results.size(); ++i) {
    results[i].one_thread = one[i];
    results[i].two_threads = two[i];
  }
  return results;
}

}  // namespace elbowroom::accuracy
