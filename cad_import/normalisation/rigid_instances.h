// Instances as rigid motions.
#pragma once

#include <string>
#include <vector>

#include "cad_import/model/cad_model.h"
#include "cad_import/model/raw_scene.h"

namespace elbowroom::cad_import {

struct RigidInstances {
  std::vector<RawShape> shapes;
  std::vector<CadInstance> instances;
};

// Scales and mirrors go into shapes, one made for each different stretch; shapes that no instance shows go.
// Throws: Error{kGeometry} naming `where` when an instance isn't placed at a finite point.
[[nodiscard]] RigidInstances MakeRigid(const RawScene& scene, const std::string& where);

}  // namespace elbowroom::cad_import
