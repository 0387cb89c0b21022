#include "cad_import/normalisation/surface_defects.h"

#include "cad_import/normalisation/self_intersections.h"
#include "cad_import/normalisation/surface_topology.h"

namespace elbowroom::cad_import {
namespace {

SurfaceDefects DefectsOf(const CadShape& shape, const std::stop_token& stop) {
  const core::TriangleMesh& mesh = *shape.mesh;
  const auto at = [&](std::int32_t i) { return mesh.vertices_mm[static_cast<std::size_t>(i)]; };
  SurfaceDefects defects;
  ForEachEdge(SortedEdgeUses(mesh), [&](std::span<const EdgeUse> edge) {
    const SurfaceDefects::Segment segment{at(edge[0].low), at(edge[0].high)};
    switch (KindOf(edge)) {
      case EdgeKind::kSound:
        break;
      case EdgeKind::kOpen:
        defects.open_edges.push_back(segment);
        break;
      case EdgeKind::kNonManifold:
        defects.non_manifold_edges.push_back(segment);
        break;
      case EdgeKind::kInconsistent:
        defects.inconsistent_edges.push_back(segment);
        break;
    }
  });
  if (shape.surface.self_intersections.value_or(1) == 0) return defects;
  for (const std::uint32_t i : FindSelfIntersections(mesh, stop).triangles) {
    const auto& [a, b, c] = mesh.triangles[i];
    defects.crossing.push_back({at(a), at(b), at(c)});
  }
  return defects;
}

}  // namespace

SurfaceDefects FindDefects(const CadModel& model, const core::Progress& progress,
                           const std::stop_token& stop) {
  std::vector<SurfaceDefects> of_shapes;
  for (const CadShape& shape : model.shapes) {
    progress.Report(static_cast<std::int64_t>(of_shapes.size()),
                    static_cast<std::int64_t>(model.shapes.size()), "looking for defects in mesh");
    core::ThrowIfStopped(stop, "the search for defects");
    of_shapes.push_back(DefectsOf(shape, stop));
  }
  SurfaceDefects all;
  for (const CadInstance& instance : model.instances) {
    const SurfaceDefects& of_shape = of_shapes[instance.shape];
    const core::RigidTransform& model_from_shape = instance.model_from_shape;
    const auto add = [&](const std::vector<SurfaceDefects::Segment>& from,
                         std::vector<SurfaceDefects::Segment>* to) {
      for (const auto& [a, b] : from) to->emplace_back(model_from_shape * a, model_from_shape * b);
    };
    add(of_shape.open_edges, &all.open_edges);
    add(of_shape.non_manifold_edges, &all.non_manifold_edges);
    add(of_shape.inconsistent_edges, &all.inconsistent_edges);
    for (const auto& [a, b, c] : of_shape.crossing)
      all.crossing.push_back({model_from_shape * a, model_from_shape * b, model_from_shape * c});
  }
  return all;
}

}  // namespace elbowroom::cad_import
