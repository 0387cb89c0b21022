#include "tests/accuracy/view_methods.h"

#include <fmt/format.h>

#include <utility>

#include "recon/hull_mesh.h"
#include "recon/ray_cast.h"
#include "recon/visual_hull.h"
#include "tests/accuracy/drawn_mesh.h"

namespace elbowroom::accuracy {
namespace {

recon::DepthMap MarchedView(const ViewTask& task, double step_mm) {
  recon::HullView view = recon::ViewHull(recon::MakeVisualHull(task.rig, task.masks), task.view, step_mm);
  return {view.width_px, view.height_px, std::move(view.depth_mm), view.hit_pixels};
}

recon::DepthMap MeshedView(const ViewTask& task, double edge_mm) {
  return DrawMesh(recon::MeshHull(recon::MakeVisualHull(task.rig, task.masks), edge_mm).mesh, task.view);
}

}  // namespace

recon::DepthMap ExactView(const ViewTask& task) { return MarchedView(task, 0.25); }

std::vector<ViewMethod> ViewMethods() {
  std::vector<ViewMethod> methods;
  for (const double step_mm : {0.05, 0.25, 1.0, 4.0}) {
    methods.push_back({"sphere tracing", fmt::format("steps of {} mm", step_mm),
                       [=](const ViewTask& task) { return MarchedView(task, step_mm); }});
  }
  for (const double edge_mm : {2.0, 4.0, 8.0}) {
    methods.push_back({"octree mesh", fmt::format("edges of {} mm", edge_mm),
                       [=](const ViewTask& task) { return MeshedView(task, edge_mm); }});
  }
  return methods;
}

}  // namespace elbowroom::accuracy
