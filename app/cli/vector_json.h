// Points and directions in what `--json` prints.
#pragma once

#include <Eigen/Core>
#include <nlohmann/json.hpp>

namespace elbowroom::cli {

// [x, y, z]
[[nodiscard]] inline nlohmann::json JsonOf(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

}  // namespace elbowroom::cli
