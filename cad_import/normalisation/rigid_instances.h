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

// Splits each placement into a rigid motion and a stretch (scales and mirrors). The stretch goes into the
// shape: one shape is made for each different stretch. Shapes that no instance shows are dropped. Throws:
// Error{kGeometry} naming `where` when an instance isn't placed at a finite point.
[[nodiscard]] RigidInstances MakeRigid(const RawScene& scene, const std::string& where);

}  // namespace elbowroom::cad_import
