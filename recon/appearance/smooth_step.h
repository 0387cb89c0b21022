// From 0 to 1 without a kink.
#pragma once

#include <algorithm>

namespace elbowroom::recon {

// 0 up to 0, 1 from 1 on, 3 t^2 - 2 t^3 between.
[[nodiscard]] inline float SmoothStep(float t) {
  const float x = std::clamp(t, 0.0F, 1.0F);
  return x * x * (3.0F - 2.0F * x);
}

}  // namespace elbowroom::recon
