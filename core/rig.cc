#include "core/rig.h"

#include <fmt/format.h>

#include "core/error.h"
#include "core/file_limits.h"

namespace elbowroom::core {

void Rig::Validate() const {
  const std::string who = fmt::format("rig '{}'", name);
  if (cameras.empty())
    throw Error(ErrorKind::kCamera, who + " has no cameras; list at least one under 'cameras:'");
  if (cameras.size() > kMostCameras) {
    throw Error(ErrorKind::kCamera,
                fmt::format("{} has {} cameras; at most {} can be used", who, cameras.size(), kMostCameras));
  }
  const Eigen::Vector3d low = workspace_mm.min(), high = workspace_mm.max();
  if (!low.allFinite() || !high.allFinite() || (workspace_mm.sizes().array() <= 0.0).any()) {
    throw Error(
        ErrorKind::kRange,
        who + ": workspace_mm must be [x0,y0,z0,x1,y1,z1] with x0 < x1, y0 < y1, z0 < z1, all finite");
  }
}

}  // namespace elbowroom::core
