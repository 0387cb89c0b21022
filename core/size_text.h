// Sizes as text for people.
#pragma once

#include <Eigen/Core>
#include <string>

namespace elbowroom::core {

// "203.2 x 157 x 20000": up to four digits below a thousand, whole numbers from there on.
[[nodiscard]] std::string SizeText(const Eigen::Vector3d& size);

}  // namespace elbowroom::core
