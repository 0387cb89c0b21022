// Numbers of the coverage as text.
#pragma once

#include <Eigen/Core>
#include <string>

namespace elbowroom::control {

// Three digits or so: "0.123", "1.23", "12.3", "123".
[[nodiscard]] std::string MmText(double mm);
// "37 %", "0.4 %"
[[nodiscard]] std::string PercentText(double share);
// "(120, -35, 800) mm"; with a decimal where the place is within 100 mm of the origin.
[[nodiscard]] std::string PlaceText(const Eigen::Vector3d& place_mm);
// 2: "a second", 12: "a 12th", in words up to ten.
[[nodiscard]] std::string OrdinalText(std::size_t number);

}  // namespace elbowroom::control
