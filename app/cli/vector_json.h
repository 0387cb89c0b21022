// Points, directions and numbers in what `--json` prints.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

namespace elbowroom::cli {

// [x, y, z]
[[nodiscard]] inline nlohmann::json JsonOf(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

// null where there is none, or where it is infinite.
[[nodiscard]] inline nlohmann::json OrNull(std::optional<double> number) {
  return number && std::isfinite(*number) ? nlohmann::json(*number) : nlohmann::json();
}

}  // namespace elbowroom::cli
