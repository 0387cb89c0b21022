// A length or a place that is written into the 3-D view.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

#include "core/contact.h"

namespace elbowroom::control {

struct Dimension {
  Eigen::Vector3d from_in_world = Eigen::Vector3d::Zero();
  Eigen::Vector3d to_in_world = Eigen::Vector3d::Zero();  // the same: a place
  std::string text;                                       // "45.0 mm"
  std::optional<core::Verdict> band;                      // its colour; nothing: that of measurements
};

}  // namespace elbowroom::control
