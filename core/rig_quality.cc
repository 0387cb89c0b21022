#include "core/rig_quality.h"

#include <fmt/format.h>

#include <cmath>

#include "core/error.h"

namespace elbowroom::core {

void RigErrors::Validate() const {
  if (boundary_sigma_px >= 0.0 && std::isfinite(boundary_sigma_px)) return;
  throw Error(
      ErrorKind::kRange,
      fmt::format("the error of a silhouette's boundary must be 0 px or more, not {}", boundary_sigma_px));
}

}  // namespace elbowroom::core
