// The virtual parts of the simulated chain.
#pragma once

#include <vector>

#include "core/layout.h"
#include "core/triangle_mesh.h"
#include "recon/synthetic/solids.h"
#include "tests/recon/scenes/random_scene.h"

namespace elbowroom::accuracy {

// A block, a cylinder, a thin plate and an open box: closed, outwards, around their origins.
[[nodiscard]] std::vector<core::SharedMesh> ChainPartMeshes();

// One part of each mesh, turned at random, and pushed in a random direction towards objects so that its
// distance to them is `distances_mm` (one a part; negative: that much overlap) to half a millimetre.
// `objects`: what stands in world, one set a part.
[[nodiscard]] core::Layout DrawChainLayout(const std::vector<core::SharedMesh>& meshes,
                                           const std::vector<std::vector<recon::Solid>>& objects,
                                           const std::vector<double>& distances_mm, recon::Random* random);

}  // namespace elbowroom::accuracy
