// A mesh without what lies beyond a plane, and the faces of the cut.
#pragma once

#include <Eigen/Core>

#include "core/rigid_transform.h"
#include "core/triangle_mesh.h"

#include "app/control/section/section_cut.h"

namespace elbowroom::control {

// Both in the mesh's own frame. Empty meshes have no triangles.
struct CutMesh {
  core::TriangleMesh surface;    // what stays of the mesh's surface; open at the cut
  core::TriangleMesh cut_faces;  // outwards: together with the surface they are closed
};

// A corner on a plane stays. The cut has faces where the mesh is closed: what is inside by its winding
// number. Of an open mesh only those pieces of the cut that something closes. The volume is exact but for
// rounding (section_test).
[[nodiscard]] CutMesh CutOpen(const core::TriangleMesh& mesh, const core::RigidTransform& world_from_mesh,
                              const SectionCut& cut);

// What stays of a surface that isn't closed: CutOpen without faces of the cut.
[[nodiscard]] core::TriangleMesh CutSurface(const core::TriangleMesh& mesh,
                                            const core::RigidTransform& world_from_mesh,
                                            const SectionCut& cut);

}  // namespace elbowroom::control
