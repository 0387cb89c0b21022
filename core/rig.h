// The cameras of one set-up and the space they watch.
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "core/camera_model.h"

namespace elbowroom::core {

// How a camera labels a point that it can't see (behind it, outside its picture or its lens's domain).
enum class UnseenPolicy {
  kOutside,  // the paper's rule: the point is outside the hull
  kAbstain,  // the camera doesn't decide; a point that no camera sees is outside
};

struct Rig {
  std::string name;
  Eigen::AlignedBox3d workspace_mm;  // in world; the hull is clipped to it
  UnseenPolicy unseen = UnseenPolicy::kOutside;
  std::vector<CameraModel> cameras;

  // Throws: Error{kCamera} when there is no camera or more than kMostCameras, Error{kRange} when the
  // workspace is empty or not finite.
  void Validate() const;
};

}  // namespace elbowroom::core
