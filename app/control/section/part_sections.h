// Cut parts, kept while nothing about them changes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "app/control/section/section_cut.h"
#include "core/ids.h"
#include "core/rigid_transform.h"
#include "core/triangle_mesh.h"

namespace elbowroom::control {

struct PartSection {
  core::SharedMesh surface;    // in the part's frame; null: nothing of it is left
  core::SharedMesh cut_faces;  // null: the cut goes through none of it
};

// Thread: one.
class PartSections {
 public:
  // The same objects as in the last call for this part if its mesh, its place and the cut are those of then.
  // A part that no plane touches keeps its own mesh.
  [[nodiscard]] const PartSection& Of(core::PartIndex part, const core::SharedMesh& mesh,
                                      const core::RigidTransform& world_from_part, const SectionCut& cut);

  // The same of a surface that isn't closed, such as a piece of a part's; it has no faces of the cut.
  // `place`: numbers the surfaces, from 0. Null: nothing of it is left.
  [[nodiscard]] core::SharedMesh SurfaceOf(std::size_t place, const core::SharedMesh& mesh,
                                           const core::RigidTransform& world_from_part,
                                           const SectionCut& cut);

  [[nodiscard]] std::int64_t cuts() const { return cuts_; }  // since the start

 private:
  struct Kept {
    core::SharedMesh mesh;
    core::RigidTransform world_from_part;
    SectionCut cut;
    PartSection section;
  };
  std::vector<Kept> kept_, kept_surfaces_;
  std::int64_t cuts_ = 0;
};

}  // namespace elbowroom::control
