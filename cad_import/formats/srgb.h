// Conversion between sRGB and linear light.
#pragma once

#include <cmath>

namespace elbowroom::cad_import {

// One channel, 0..1, of IEC 61966-2-1.
[[nodiscard]] inline float LinearFromSrgb(float channel) {
  return channel <= 0.04045F ? channel / 12.92F : std::pow((channel + 0.055F) / 1.055F, 2.4F);
}
[[nodiscard]] inline float SrgbFromLinear(float channel) {
  return channel <= 0.0031308F ? channel * 12.92F : 1.055F * std::pow(channel, 1.0F / 2.4F) - 0.055F;
}

}  // namespace elbowroom::cad_import
