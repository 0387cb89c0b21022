#include "core/rig.h"

#include "core/error.h"

namespace elbowroom::core {

void Rig::Validate() const {
  if (cameras.empty()) {
    throw Error(ErrorKind::kCamera, "rig '" + name + "' has no cameras; list at least one under 'cameras:'");
  }
  const bool is_finite = workspace_mm.min().allFinite() && workspace_mm.max().allFinite();
  if (!is_finite || (workspace_mm.sizes().array() <= 0.0).any()) {
    throw Error(ErrorKind::kRange, "rig '" + name +
                                       "': workspace_mm must be [x0,y0,z0,x1,y1,z1] with x0 < x1, y0 < y1, "
                                       "z0 < z1, all finite");
  }
}

}  // namespace elbowroom::core
