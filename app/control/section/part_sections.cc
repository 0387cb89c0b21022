#include "app/control/section/part_sections.h"

#include <memory>
#include <utility>

#include "app/control/section/mesh_cut.h"

namespace elbowroom::control {
namespace {

core::SharedMesh SharedUnlessEmpty(core::TriangleMesh mesh) {
  if (mesh.triangles.empty()) return nullptr;
  return std::make_shared<const core::TriangleMesh>(std::move(mesh));
}

}  // namespace

const PartSection& PartSections::Of(core::PartIndex part, const core::SharedMesh& mesh,
                                    const core::RigidTransform& world_from_part, const SectionCut& cut) {
  if (kept_.size() <= part) kept_.resize(part + 1);
  Kept& kept = kept_[part];
  if (kept.mesh == mesh && kept.world_from_part == world_from_part && kept.cut == cut) return kept.section;
  kept = {mesh, world_from_part, cut, {mesh, nullptr}};
  const BoxKept left = KeptOf(cut, core::BoundsOf(*mesh, world_from_part));
  if (left == BoxKept::kNothing) {
    kept.section = {};
  } else if (left == BoxKept::kMaybeCut) {
    ++cuts_;
    CutMesh opened = CutOpen(*mesh, world_from_part, cut);
    kept.section = {SharedUnlessEmpty(std::move(opened.surface)),
                    SharedUnlessEmpty(std::move(opened.cut_faces))};
  }
  return kept.section;
}

core::SharedMesh PartSections::SurfaceOf(std::size_t place, const core::SharedMesh& mesh,
                                         const core::RigidTransform& world_from_part, const SectionCut& cut) {
  if (kept_surfaces_.size() <= place) kept_surfaces_.resize(place + 1);
  Kept& kept = kept_surfaces_[place];
  if (kept.mesh == mesh && kept.world_from_part == world_from_part && kept.cut == cut)
    return kept.section.surface;
  kept = {mesh, world_from_part, cut, {mesh, nullptr}};
  const BoxKept left = KeptOf(cut, core::BoundsOf(*mesh, world_from_part));
  if (left == BoxKept::kNothing) {
    kept.section = {};
  } else if (left == BoxKept::kMaybeCut) {
    ++cuts_;
    kept.section.surface = SharedUnlessEmpty(CutSurface(*mesh, world_from_part, cut));
  }
  return kept.section.surface;
}

}  // namespace elbowroom::control
