#include "tests/accuracy/view_methods.h"

#include <fmt/format.h>

#include <utility>

#include "recon/contours/undistorted_plane.h"
#include "recon/exact_view/hull_view.h"
#include "recon/gl/exact_view/exact_view_gl.h"
#include "recon/gl/paper_methods/plane_sweep_gl.h"
#include "recon/hull/visual_hull.h"
#include "recon/hull_mesh/hull_mesh.h"
#include "recon/paper_methods/plane_sweep.h"
#include "recon/synthetic/view_scene.h"
#include "tests/accuracy/drawn_mesh.h"

namespace elbowroom::accuracy {
namespace {

constexpr recon::HullViewOptions kDepthsAlone{.surfaces = false, .normals = false};

recon::DepthMap DepthsOf(recon::HullView view) {
  return {view.width_px, view.height_px, std::move(view.depth_mm), view.hit_pixels};
}

void AddPlaneSweeps(std::vector<ViewMethod>& methods) {
  for (const int times : {1, 3, 15}) {
    const recon::PlaneSweepOptions planes = recon::FiftyPlanes(times);
    methods.push_back(
        {"plane sweep, CPU", fmt::format("planes {:.0f} mm apart", planes.spacing_mm),
         [=](const ViewTask& task) {
           return recon::SweepPlanes(*task.rig, task.masks, task.view, task.sweep_rays, planes).picture;
         }});
  }
  recon::PlaneSweepOptions plain = recon::FiftyPlanes();
  plain.settles_regions = false;
  methods.push_back(
      {"plain plane sweep, CPU", "planes 15 mm apart", [=](const ViewTask& task) {
         return recon::SweepPlanes(*task.rig, task.masks, task.view, task.sweep_rays, plain).picture;
       }});
  const auto sweep_gl = std::make_shared<recon::gl::PlaneSweepGl>();
  for (const int times : {1, 3}) {
    const recon::PlaneSweepOptions planes = recon::FiftyPlanes(times);
    methods.push_back(
        {"plane sweep, GL", fmt::format("planes {:.0f} mm apart", planes.spacing_mm),
         [=](const ViewTask& task) {
           return sweep_gl->Sweep(*task.rig, task.masks, task.view, task.sweep_rays, planes).picture;
         }});
  }
  recon::PlaneSweepOptions paper = recon::FiftyPlanes();
  paper.undistortion_grid = 5;
  methods.push_back({"the paper's sweep, GL", "planes 15 mm apart", [=](const ViewTask& task) {
                       return sweep_gl
                           ->Sweep(*task.rig, task.masks, task.view, task.sweep_rays, paper,
                                   recon::gl::SweepPasses::kOneAPlaneAndCamera)
                           .picture;
                     }});
}

}  // namespace

ViewTask::ViewTask(std::shared_ptr<const core::Rig> of_rig, std::vector<core::SoftMask> of_masks,
                   core::CameraModel of_view)
    : rig(std::move(of_rig)),
      masks(std::move(of_masks)),
      view(std::move(of_view)),
      planes(recon::MakeUndistortedPlanes(*rig)),
      rays(view),
      sweep_rays(view) {}

recon::DepthMap ExactView(const ViewTask& task) {
  return DepthsOf(recon::ViewHull(task.Hull(), task.rays, kDepthsAlone));
}

std::vector<ViewMethod> ViewMethods() {
  std::vector<ViewMethod> methods;
  methods.push_back({"exact view", "CPU", ExactView});
  methods.push_back(
      {"exact view", "GL", [card = std::make_shared<recon::gl::ExactViewGl>()](const ViewTask& task) {
         return DepthsOf(card->ViewHull(task.Hull(), task.rays, kDepthsAlone));
       }});
  AddPlaneSweeps(methods);
  for (const double edge_mm : {2.0, 4.0, 8.0}) {
    methods.push_back({"octree mesh", fmt::format("edges of {} mm", edge_mm), [=](const ViewTask& task) {
                         return DrawMesh(recon::MeshHull(task.Hull(), edge_mm).mesh, task.view);
                       }});
  }
  return methods;
}

}  // namespace elbowroom::accuracy
