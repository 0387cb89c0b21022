#include "core/size_text.h"

#include <fmt/format.h>

#include <cmath>

namespace elbowroom::core {
namespace {

std::string NumberText(double number) {
  constexpr double kFourDigits = 1000.0;
  return std::abs(number) < kFourDigits ? fmt::format("{:.4g}", number) : fmt::format("{:.0f}", number);
}

}  // namespace

std::string SizeText(const Eigen::Vector3d& size) {
  return fmt::format("{} x {} x {}", NumberText(size.x()), NumberText(size.y()), NumberText(size.z()));
}

}  // namespace elbowroom::core
