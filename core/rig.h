// The cameras of one set-up and the space they watch.
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "core/camera_model.h"

namespace elbowroom::core {

// What a camera says of a point that it can't see (behind it, outside its picture or its lens's domain).
enum class UnseenPolicy {
  kOutside,  // the paper's rule: the point is outside the hull
  kAbstain,  // that camera has no say; a point that no camera sees is outside
};

struct Rig {
  std::string name;
  Eigen::AlignedBox3d workspace_mm;  // world; the reconstruction volume, which clips the hull
  UnseenPolicy unseen = UnseenPolicy::kOutside;
  std::vector<CameraModel> cameras;

  // Throws: Error{kCamera} when there is no camera, Error{kRange} when the workspace is empty or not finite.
  void Validate() const;
};

}  // namespace elbowroom::core
