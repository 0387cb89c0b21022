#include "app/control/layers/color_scale.h"

#include <cmath>

#include "core/error.h"

namespace elbowroom::control {

double RoundedUp(double value) {
  core::Require(value >= 0.0 && std::isfinite(value), "a scale ends at 0 or more");
  if (value == 0.0) return 0.0;
  constexpr double kRounding = 1.0 - 1e-6;
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  for (const double step : {1.0, 2.0, 5.0})
    if (step * power >= kRounding * value) return step * power;
  return 10.0 * power;
}

}  // namespace elbowroom::control
