// Sizes for people.
#pragma once

#include <Eigen/Core>
#include <string>

namespace elbowroom::core {

// "203.2 x 157 x 20000": to four digits, and whole from a thousand on.
[[nodiscard]] std::string SizeText(const Eigen::Vector3d& size);

}  // namespace elbowroom::core
