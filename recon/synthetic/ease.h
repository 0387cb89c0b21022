// Smooth starts and stops of scripted motions.
#pragma once

#include <algorithm>

namespace elbowroom::recon {

// 0 before `begin`, 1 after `end`, with continuous speed and acceleration between.
[[nodiscard]] inline double Ease(double at, double begin, double end) {
  const double t = std::clamp((at - begin) / (end - begin), 0.0, 1.0);
  return t * t * t * (t * (6.0 * t - 15.0) + 10.0);
}

}  // namespace elbowroom::recon
