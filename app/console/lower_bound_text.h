// How a certified lower bound is written.
#pragma once

#include <QString>
#include <cmath>

namespace elbowroom::console {

// With one decimal, rounded down: what is shown is a lower bound too.
[[nodiscard]] inline QString LowerBoundText(double lower_bound_mm) {
  return QString::number(std::floor(10.0 * lower_bound_mm) / 10.0, 'f', 1);
}

}  // namespace elbowroom::console
